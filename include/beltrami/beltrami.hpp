// beltrami from C++17: views of the caller's arrays, contexts that free themselves, errors as
// exceptions or as results, callables. A layer of inline functions over <beltrami/beltrami.h>,
// which says what everything means.
//
//   beltrami::Context context;
//   context.set(beltrami::option::kTargetEnergy, 2.02);
//   const beltrami::Atlas atlas = context.unwrap(beltrami::Surface(positions, triangles));
//   const std::vector<beltrami::Uv32> uvs = atlas.corner_uvs<beltrami::Uv32>();
//
// <beltrami/adaptors/...> has surfaces from matrices of Eigen and meshes of OpenMesh and CGAL.
#ifndef BELTRAMI_BELTRAMI_HPP
#define BELTRAMI_BELTRAMI_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/bake.hpp>
#include <beltrami/cpp/checks.hpp>
#include <beltrami/cpp/context.hpp>
#include <beltrami/cpp/editor.hpp>
#include <beltrami/cpp/options.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/results.hpp>
#include <beltrami/cpp/span.hpp>
#include <beltrami/cpp/surface.hpp>

#endif  // BELTRAMI_BELTRAMI_HPP
