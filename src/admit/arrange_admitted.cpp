#include "admit/arrange_admitted.h"

#include <utility>
#include <vector>

#include "base/types.h"
#include "mesh/locality.h"
#include "mesh/surface.h"

namespace beltrami {

void arrange_admitted(Admitted& admitted, const Work& work) {
  std::vector<Triangle> faces = std::move(admitted.surface.faces);
  const Arrangement order = arrange(admitted.surface.positions, faces, work);
  admitted.surface = build_surface(in_order(admitted.surface.positions, order.vertices, work),
                                   std::move(faces), work);
  admitted.topology = topology_of(admitted.surface, work);
  admitted.input_vertex = in_order(admitted.input_vertex, order.vertices, work);
  admitted.input_face = in_order(admitted.input_face, order.faces, work);
  std::vector<bool> reversed(order.faces.size());
  for (std::size_t f = 0; f < reversed.size(); ++f) {
    reversed[f] = admitted.reversed[order.faces[f]];
  }
  admitted.reversed = std::move(reversed);
}

}  // namespace beltrami
