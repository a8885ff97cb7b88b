// Atlases of small surfaces, judged from outside: tests/shapes/properties.h says what they owe.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "shapes/properties.h"
#include "shapes/shape.h"
#include "shapes/shapes.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

using Provider = FuzzedDataProvider;
using shapes::Shape;

/// A torus, a tube, a sphere or a sheet of a few cells, of which vertices are shifted.
Shape bent_grid(Provider& data) {
  shapes::GridSize size{data.ConsumeIntegralInRange(1, 3), data.ConsumeIntegralInRange(1, 4)};
  size.quads = data.ConsumeBool();
  const double around = data.ConsumeFloatingPointInRange(0.0, 6.3);
  const double along = data.ConsumeFloatingPointInRange(0.0, 6.3);
  const double radius = data.ConsumeFloatingPointInRange(0.5, 4.0);
  Shape shape = shapes::grid(size, [&](double u, double v) -> shapes::Point3 {
    const double ring = radius + std::cos(along * v);
    return {ring * std::cos(around * u), ring * std::sin(around * u) + u, std::sin(along * v) + v};
  });
  for (shapes::Point3& p : shape.positions) {
    for (double& x : p) x += data.ConsumeIntegralInRange(-3, 3) / 8.0;
  }
  return shape;
}

/// A shape of the tests' own kinds, or a bent grid; some of its faces are left out.
Shape any_shape(Provider& data) {
  constexpr std::size_t kMostFaces = 24;
  Shape shape = data.ConsumeBool() ? bent_grid(data)
                                   : shapes::make_shape(data.ConsumeIntegral<std::uint32_t>());
  shape.flat = false;
  if (shape.faces() > kMostFaces || data.ConsumeBool()) {
    std::vector<char> keep(shape.faces(), 1);
    const std::size_t first = shape.faces() > kMostFaces ? shape.faces() - kMostFaces : 0;
    for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = f >= first;
    for (int i = data.ConsumeIntegralInRange(0, 8); i > 0; --i) {
      keep[data.ConsumeIntegralInRange<std::size_t>(0, keep.size() - 1)] = 0;
    }
    shape = shapes::only(shape, keep);
  }
  shape.resolution = data.ConsumeIntegralInRange(0, 7) ? 32 : 256;
  shape.margin = data.ConsumeIntegralInRange(0, 4);
  return shape;
}

}  // namespace

void run_one(std::string_view bytes) {
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const auto way = shapes::kWays[data.ConsumeIntegralInRange<std::size_t>(0, 3)];
  const Shape shape = any_shape(data);
  if (shape.faces() == 0) return;
  const shapes::Report report = shapes::check(shape, way);
  for (const shapes::Finding& finding : report.findings) {
    if (finding.fault == shapes::Fault::kTime || finding.fault == shapes::Fault::kStatus) continue;
    std::fprintf(stderr, "%s, %s: %s\n", shape.kind.c_str(), name_of(way).data(),
                 finding.what.c_str());
    broken(name_of(finding.fault).data());
  }
}

}  // namespace beltrami::fuzz
