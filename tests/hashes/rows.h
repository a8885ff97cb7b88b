// The rows of the table of hashes, a group each.
#pragma once

#include <string>
#include <vector>

namespace beltrami::hashes {

/// Of the elementary functions.
std::vector<std::string> function_rows();

/// Of small meshes in every mode, and of the shipped bust; each at one thread and at two, which
/// must agree. They go through the C ABI, so that changes inside keep the rows.
std::vector<std::string> small_rows();
std::vector<std::string> bust_rows();

/// One row for the 500 random disks, and one for every hundred of them.
std::vector<std::string> random_rows();

}  // namespace beltrami::hashes
