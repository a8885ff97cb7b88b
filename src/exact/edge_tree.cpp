#include "exact/edge_tree.h"

#include <vector>

#include "base/types.h"

namespace beltrami {
namespace {

Box2 box_of(const ClosedPolygon& polygon, Index edge) {
  return Box2(polygon.start(edge)).extend(polygon.end(edge));
}

std::vector<Box2> boxes_of(const ClosedPolygon& polygon) {
  std::vector<Box2> boxes;
  boxes.reserve(static_cast<std::size_t>(polygon.edge_count()));
  for (Index e = 0; e < polygon.edge_count(); ++e) boxes.push_back(box_of(polygon, e));
  return boxes;
}

}  // namespace

EdgeTree::EdgeTree(const ClosedPolygon& polygon) : polygon_(polygon), tree_(boxes_of(polygon)) {}

void EdgeTree::update(Index edge) {
  tree_.update(edge, box_of(polygon_, edge));
}

}  // namespace beltrami
