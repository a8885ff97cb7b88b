// From the caller's images and UVs to what the room `bake` takes.
#pragma once

#include <beltrami/beltrami.h>

#include <span>
#include <vector>

#include "bake/bake.h"
#include "bake/page.h"
#include "base/work.h"

namespace beltrami {

/// Copies the header with its counts, choices and images checked. Throws Error INVALID_ARGUMENT or
/// EMPTY.
beltrami_bake_job read_bake_header(const beltrami_bake_job* theirs);

/// The caller's room for pixels and masks.
struct BakeRoom {
  std::vector<PageRoom> pages;
  std::span<Filled> masks;
};

/// Throws Error INVALID_ARGUMENT. `job` has passed read_bake_header.
BakeRoom room_of(const beltrami_bake_job& job, const beltrami_baked* out);

/// Reads UVs, pages and positions. Throws Error INVALID_ARGUMENT, or NON_FINITE with the corner.
BakeProblem read_bake_problem(const beltrami_bake_job& job, const Work& work);

/// Writes what the caller's size covers, but for what the caller gave.
void write_baked(const BakeReport& report, double seconds, double cpu_seconds, beltrami_baked* out);

/// Throws Error INVALID_ARGUMENT where most texels have no source: an image that is made up is none
/// that anybody looks for.
void require_sources(const BakeReport& report);

}  // namespace beltrami
