#include "exact/certificate.h"

#include "base/interrupt.h"
#include "base/parallel.h"
#include "exact/orientation.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

int face_orientation(const Triangle& face, const std::vector<Vec2>& uvs) {
  return orientation(uvs[face[0]], uvs[face[1]], uvs[face[2]]);
}

}  // namespace

std::vector<Index> non_positive_faces(const std::vector<Triangle>& faces,
                                      const std::vector<Vec2>& uvs, const Work& work) {
  return parallel_filter(work, size_of(faces), kGrain,
                         [&](Index f) { return face_orientation(faces[f], uvs) <= 0; });
}

Orientations count_orientations(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                                const Work& work) {
  const std::vector<Index> bad = non_positive_faces(faces, uvs, work);
  Orientations counts;
  counts.positive = size_of(faces) - size_of(bad);
  PollSometimes poll;
  for (const Index f : bad) {
    poll();
    ++(face_orientation(faces[f], uvs) < 0 ? counts.negative : counts.degenerate);
  }
  if (!bad.empty()) counts.first_bad_face = bad.front();
  return counts;
}

Certificate certify(const std::vector<Triangle>& faces, const std::vector<Index>& loop,
                    const std::vector<Vec2>& uvs, const Work& work) {
  return {count_orientations(faces, uvs, work), count_crossings(loop, uvs)};
}

}  // namespace beltrami
