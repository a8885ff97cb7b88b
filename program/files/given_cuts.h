// Cuts that the user gives: labels of faces that a file has, and edges in a file of their own.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "files/mesh_file.h"

namespace beltrami::cli {

/// One number per face: "materials", "groups" or "objects" of an OBJ file, or the face property of
/// this name of a PLY or glTF file; in the singular or the plural, as it is there. Throws Failure
/// where the file has no such thing, which says what the `flag` is `to` do.
std::vector<std::uint64_t> face_labels(const MeshFile& file, const std::string& given,
                                       const std::string& flag, const std::string& to);

/// What labels of face_labels are called in the file, by their numbers: "usemtl wood", or a number.
/// Precondition: it has them.
std::map<std::uint64_t, std::string> label_texts(const MeshFile& file, const std::string& given,
                                                 const std::vector<std::uint64_t>& labels);

/// Pairs of vertex numbers, counted from 0, from a text file: anything but digits parts them.
/// Throws Failure for an odd count of numbers and for those that are no vertex of the file.
std::vector<std::uint32_t> read_seams(const std::string& path, const MeshFile& file);

/// How many of these seams join vertices that no face has side by side, also where vertices at one
/// place are one: nothing is cut there. With the first of them.
struct SeamsWithoutEdge {
  std::uint64_t count = 0;
  std::uint32_t from = 0, to = 0;
};
SeamsWithoutEdge seams_without_edge(const std::vector<std::uint32_t>& seams, const MeshFile& file);

}  // namespace beltrami::cli
