// A page for browsers that shows a model beside its layout, in one file that needs no network.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "files/surface.h"

namespace beltrami::cli {

/// Of a triangle that is in no chart.
inline constexpr std::uint32_t kNoChart = 0xffffffff;

/// What the viewer draws, as the page holds it.
struct HtmlMesh {
  std::string description;  ///< JSON: counts, and from where to look at the model
  std::string arrays;       ///< base64
};

/// `mesh` with finite UVs, `energies` (symmetric Dirichlet) and `charts` of its triangles. The
/// viewer gets single precision. Throws std::bad_alloc.
HtmlMesh html_mesh(const TriangleView& mesh, const std::vector<double>& energies,
                   const std::vector<std::uint32_t>& charts);

/// Hands on the page in parts. `report`: that of to_json.
void write_html(const HtmlMesh& mesh, std::string_view report,
                const std::function<void(std::string_view)>& sink);

}  // namespace beltrami::cli
