// beltrami as the parameterization of xatlas (https://github.com/jpcy/xatlas):
//
//   xatlas::ChartOptions options;
//   options.paramFunc = beltrami_xatlas_parameterize;
//   xatlas::Generate(atlas, options);
#pragma once

#include <cstdint>

/// Has the signature of xatlas::ParameterizeFunc. Writes injective UVs of low distortion, in the
/// unit of length of the positions, in the order of the vertices. Where a chart is no disk, or its
/// UVs are not injective as floats, `texcoords` stays as it was: xatlas hands in an orthogonal
/// projection, and judges what it gets back. Reentrant, as xatlas calls it from its own threads.
void beltrami_xatlas_parameterize(const float* positions, float* texcoords,
                                  std::uint32_t vertex_count, const std::uint32_t* indices,
                                  std::uint32_t index_count);
