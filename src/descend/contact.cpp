#include "descend/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/interrupt.h"
#include "exact/box_tree.h"
#include "exact/crossings.h"

namespace beltrami {
namespace {

/// How far the barrier reaches, in edges: far enough for a Newton step to see what it runs into.
/// With half an edge the steps become twice as many; with three the map ends higher.
constexpr double kReach = 2;
/// More contacts than so many for each vertex tell a step nothing new.
constexpr int kMostContacts = 32;
/// Of the barrier in an objective, times half the energy: at the end it raises the energy by a
/// thousandth.
constexpr double kStrength = 0.01;
/// The reach grows as the energy falls: this is what it grows by in a step that is not the first.
constexpr double kAhead = 1.2;
/// Points of one boundary part are near each other: of the way between them along the boundary.
constexpr double kReachAlong = 0.25;
/// Consecutive vertices whose edges nearby are looked up at once.
constexpr Index kTogether = 8;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A pair with the reach at scale 1, at another.
Contact at_scale(Contact contact, double scale) {
  contact.reach *= scale;
  return contact;
}

/// Where a vertex is nearest to an edge.
struct Nearest {
  double share;  ///< of the edge, up to there
  Vec2 apart;    ///< from there to the vertex
  double distance;
  /// Sine of the angle between the edge and `apart`, positive outside, where the edge has the
  /// surface on its left: 1 or -1 but beyond the ends of the edge.
  double outside;
};

Nearest nearest_on_edge(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a, away = p - a;
  const double length_sq = edge.squaredNorm();
  const double along = length_sq > 0 ? away.dot(edge) / length_sq : 0.0;
  const double share = std::clamp(along, 0.0, 1.0);
  const Vec2 apart = away - share * edge;
  const double distance = apart.norm(), turn = cross(edge, away);
  if (share == along) return {share, apart, distance, turn > 0 ? -1.0 : 1.0};
  const double product = std::sqrt(length_sq) * distance;
  return {share, apart, distance, product > 0 ? std::clamp(-turn / product, -1.0, 1.0) : 1.0};
}

double barrier(double x) {
  if (x >= 1) return 0;
  const double rest = 1 - x;
  return x > 0 ? rest * rest * rest / x : std::numeric_limits<double>::infinity();
}

double barrier_slope(double x) {
  const double rest = 1 - x;
  return -rest * rest * (3 + rest / x) / x;
}

double barrier_curvature(double x) {
  const double ratio = (1 - x) / x;
  return 2 * ratio * (3 + 3 * ratio + ratio * ratio);
}

/// The derivative of the distance by the six coordinates of a pair.
Vector6 distance_gradient(const Nearest& near) {
  const Vec2 normal = near.apart / near.distance;
  Vector6 gradient;
  gradient << normal, -(1 - near.share) * normal, -near.share * normal;
  return gradient;
}

/// The derivative of Nearest::outside, where the vertex is beyond the ends of the edge.
Vector6 outside_gradient(const Nearest& near, const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a, away = p - a;
  const double length = edge.norm(), turn = cross(edge, away);
  const Vec2 by_vertex = Vec2(edge.y(), -edge.x()) / length;
  const Vec2 by_to = Vec2(-away.y(), away.x()) / length + turn / (length * length * length) * edge;
  Vector6 by_height;
  by_height << by_vertex, -by_vertex - by_to, by_to;
  return (by_height - near.outside * distance_gradient(near)) / near.distance;
}

/// One pair's term and its gradient. Beyond the ends of the edge the barrier fades out as the
/// vertex gets behind it, where the next edge takes over.
struct Term {
  double value;
  Vector6 gradient;
};

Term contact_term(const Contact& c, const Nearest& near, const std::vector<Vec2>& uvs) {
  const double x = near.distance / c.reach, share = near.outside * near.outside;
  Term term{c.weight * share * barrier(x),
            (c.weight * share * barrier_slope(x) / c.reach) * distance_gradient(near)};
  if (share < 1) {
    term.gradient += (2 * c.weight * near.outside * barrier(x)) *
                     outside_gradient(near, uvs[c.vertex], uvs[c.from], uvs[c.to]);
  }
  return term;
}

double stiffness_across(const Contact& c, const Nearest& near) {
  return c.weight * near.outside * near.outside * barrier_curvature(near.distance / c.reach) /
         (c.reach * c.reach);
}

/// The first t in (0, limit) at which p and the edge a-b, all moving straight, become collinear
/// with p on the edge, or a rounding error beside it; `limit` if they do not.
double touch_time(const std::array<Vec2, 3>& place, const std::array<Vec2, 3>& move, double limit) {
  constexpr double kSlack = 1e-9;
  const Vec2 edge = place[2] - place[1], away = place[0] - place[1];
  const Vec2 edge_move = move[2] - move[1], away_move = move[0] - move[1];
  const double c0 = cross(edge, away), c2 = cross(edge_move, away_move);
  const double c1 = cross(edge, away_move) + cross(edge_move, away);
  const double discriminant = c1 * c1 - 4 * c0 * c2;
  if (!(discriminant >= 0)) return limit;
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
  double first = limit;
  for (const double t : {c0 / q, q / c2}) {
    if (!(t > 0 && t < first)) continue;  // not numbers neither
    const Vec2 edge_then = edge + t * edge_move, away_then = away + t * away_move;
    const double length_sq = edge_then.squaredNorm(), share = away_then.dot(edge_then);
    if (share >= -kSlack * length_sq && share <= (1 + kSlack) * length_sq) first = t;
  }
  return first;
}

}  // namespace

BoundaryContact::BoundaryContact(const std::vector<Index>& loop, const std::vector<double>& lengths,
                                 std::vector<double> scales)
    : loop_(loop), lengths_(lengths), scales_(std::move(scales)), along_(1, 0.0) {
  for (const double length : lengths_) along_.push_back(along_.back() + length);
}

std::size_t BoundaryContact::most() const {
  return kMostContacts * loop_.size();
}

/// At scale 1; so are those of pairs.
double BoundaryContact::reach_of_vertex(Index i) const {
  return kReach * std::min(scales_[before(i)], scales_[i]);
}

double BoundaryContact::reach(Index i, Index e) const {
  const auto way_to = [&](Index k) {
    const double way = std::abs(along_[k] - along_[i]);
    return std::min(way, along_.back() - way);
  };
  return std::min({reach_of_vertex(i), kReach * scales_[e],
                   kReachAlong * std::min(way_to(e), way_to(after(e)))});
}

/// Calls visit(i, e) for the vertices i and the edges e, none that ends there, whose boxes meet,
/// that of an edge being around the boxes of its ends, until it returns false.
template <class BoxOf, class EndBoxOf, class Visit>
void BoundaryContact::for_each_near(const BoxOf& vertex_box, const EndBoxOf& edge_end_box,
                                    const Visit& visit) const {
  const Index count = size_of(loop_);
  std::vector<Box2> boxes;
  boxes.reserve(loop_.size());
  for (Index e = 0; e < count; ++e) {
    boxes.push_back(edge_end_box(e).merged(edge_end_box(after(e))));
  }
  BoxTree tree(boxes);
  std::vector<Index> edges;  // near one of the vertices from `first` on
  PollSometimes poll;
  for (Index first = 0; first < count; first += kTogether) {
    const Index end = std::min(first + kTogether, count);
    Box2 all;
    for (Index i = first; i < end; ++i) all.extend(vertex_box(i));
    edges.clear();
    tree.for_each_near(
        all, [] { return true; },
        [&](Index e) {
          edges.push_back(e);
          return true;
        });
    for (Index i = first; i < end; ++i) {
      const Box2 box = vertex_box(i);
      for (const Index e : edges) {
        poll();
        if (e == i || after(e) == i || !boxes[e].intersects(box)) continue;
        if (!visit(i, e)) return;
      }
    }
  }
}

void BoundaryContact::fit(const std::vector<Vec2>& uvs, double energy) {
  Neighbours unknown;
  fit(uvs, energy, unknown);
}

void BoundaryContact::fit(const std::vector<Vec2>& uvs, double energy, Neighbours& known) {
  strength_ = 0.5 * kStrength * energy;
  scale_ = std::min(1.0, std::sqrt(2 / energy));
  if (known.scale < scale_) known = neighbours(uvs);
  if (known.scale >= scale_ && find(uvs, known).size() <= most()) return;
  while (scale_ > std::numeric_limits<double>::min() && find(uvs, 1, most() + 1).size() > most()) {
    scale_ *= 0.5;
  }
}

bool BoundaryContact::is_pressed(const std::vector<Vec2>& uvs) const {
  const std::size_t near = find(uvs, 1, most() + 1).size();
  return near > 0 && near <= most();
}

/// Calls visit(contact, near), the contact's reach being that at scale 1, for the pairs nearer than
/// their reach at `scale` whose vertex is no further behind the edge than `behind`, until it
/// returns false.
template <class Visit>
void BoundaryContact::for_each_pair(const std::vector<Vec2>& uvs, double scale, double behind,
                                    const Visit& visit) const {
  const auto around_vertex = [&](Index i) {
    const double reach = scale * reach_of_vertex(i);
    const Vec2& p = uvs[loop_[i]];
    return Box2(p - Vec2(reach, reach), p + Vec2(reach, reach));
  };
  const auto at_vertex = [&](Index i) { return Box2(uvs[loop_[i]]); };
  for_each_near(around_vertex, at_vertex, [&](Index i, Index e) {
    const Index p = loop_[i], a = loop_[e], b = loop_[after(e)];
    const double limit = reach(i, e);
    const Nearest near = nearest_on_edge(uvs[p], uvs[a], uvs[b]);
    if (near.distance >= scale * limit || near.outside <= behind) return true;
    return visit(Contact{p, a, b, limit, (lengths_[before(i)] + lengths_[i]) * lengths_[e]}, near);
  });
}

std::vector<Contact> BoundaryContact::find(const std::vector<Vec2>& uvs, double margin,
                                           std::size_t most) const {
  std::vector<Contact> contacts;
  // Behind the edge is the surface, and no contact.
  for_each_pair(uvs, margin * scale_, margin > 1 ? -0.5 : 0.0,
                [&](const Contact& c, const Nearest&) {
                  contacts.push_back(at_scale(c, scale_));
                  return contacts.size() < most;
                });
  return contacts;
}

Neighbours BoundaryContact::neighbours(const std::vector<Vec2>& uvs) const {
  Neighbours known{{}, std::min(1.0, kAhead * scale_), {}};
  for_each_pair(uvs, known.scale, 0, [&](const Contact& c, const Nearest& near) {
    known.pairs.push_back(c);
    known.distances.push_back(near.distance);
    return known.pairs.size() <= 2 * most();
  });
  if (known.pairs.size() > 2 * most()) known = {};
  return known;
}

std::vector<Contact> BoundaryContact::find(const std::vector<Vec2>& uvs,
                                           const Neighbours& known) const {
  if (known.scale < scale_) return find(uvs);
  std::vector<Contact> contacts;
  for (std::size_t k = 0; k < known.pairs.size(); ++k) {
    const Contact c = at_scale(known.pairs[k], scale_);
    if (known.distances[k] < c.reach) contacts.push_back(c);
  }
  return contacts;
}

double BoundaryContact::energy(const std::vector<Vec2>& uvs) const {
  return contact_energy(find(uvs), uvs);
}

double BoundaryContact::add_gradient(const std::vector<Vec2>& uvs, double strength,
                                     std::vector<Vec2>& gradient) const {
  double sum = 0;
  for (const Contact& c : find(uvs)) {
    const Nearest near = nearest_on_edge(uvs[c.vertex], uvs[c.from], uvs[c.to]);
    const Term term = contact_term(c, near, uvs);
    sum += term.value;
    gradient[c.vertex] += strength * term.gradient.segment<2>(0);
    gradient[c.from] += strength * term.gradient.segment<2>(2);
    gradient[c.to] += strength * term.gradient.segment<2>(4);
  }
  return sum;
}

std::vector<double> BoundaryContact::stiffness(const std::vector<Vec2>& uvs) const {
  std::vector<double> result(uvs.size(), 0);
  for (const Contact& c : find(uvs)) {
    const Nearest near = nearest_on_edge(uvs[c.vertex], uvs[c.from], uvs[c.to]);
    const double across = stiffness_across(c, near);
    result[c.vertex] += across;
    result[c.from] += (1 - near.share) * across;
    result[c.to] += near.share * across;
  }
  return result;
}

std::vector<Touch> BoundaryContact::touches(const std::vector<Vec2>& uvs,
                                            const std::vector<Vec2>& direction, double limit,
                                            double all_before) const {
  std::vector<Touch> found;
  double first = limit;
  const auto until = [&] { return std::max(first, std::min(all_before, limit)); };
  // Whoever moves along with the whole sees its parts move less, in smaller boxes.
  Vec2 mean = Vec2::Zero();
  for (const Index v : loop_) mean += direction[v] / static_cast<double>(loop_.size());
  const auto swept = [&](Index i, double time) {
    const Vec2 &p = uvs[loop_[i]], d = direction[loop_[i]] - mean;
    Box2 box(p);
    return box.extend(p + time * d);
  };
  const auto vertex_swept = [&](Index i) { return swept(i, until()); };
  const auto end_swept = [&](Index i) { return swept(i, limit); };
  for_each_near(vertex_swept, end_swept, [&](Index i, Index e) {
    const Index p = loop_[i], a = loop_[e], b = loop_[after(e)];
    const double time =
        touch_time({uvs[p], uvs[a], uvs[b]}, {direction[p], direction[a], direction[b]}, limit);
    // There may be as many as pairs of edges.
    if (time < until()) found.push_back({p, a, time});
    first = std::min(first, time);
    return true;
  });
  return found;
}

double BoundaryContact::first_touch(const std::vector<Vec2>& uvs,
                                    const std::vector<Vec2>& direction, double limit) const {
  for (const Touch& touch : touches(uvs, direction, limit)) limit = std::min(limit, touch.time);
  return limit;
}

bool BoundaryContact::is_simple(const std::vector<Vec2>& uvs) const {
  return beltrami::is_simple(loop_, uvs);
}

double contact_energy(const std::vector<Contact>& contacts, const std::vector<Vec2>& uvs) {
  double sum = 0;
  for (const Contact& c : contacts) {
    const Nearest near = nearest_on_edge(uvs[c.vertex], uvs[c.from], uvs[c.to]);
    sum += c.weight * near.outside * near.outside * barrier(near.distance / c.reach);
  }
  return sum;
}

double contact_stiffness(const Contact& c, const std::vector<Vec2>& uvs) {
  return stiffness_across(c, nearest_on_edge(uvs[c.vertex], uvs[c.from], uvs[c.to]));
}

double share_of_reach(const Contact& c, const std::vector<Vec2>& uvs) {
  return nearest_on_edge(uvs[c.vertex], uvs[c.from], uvs[c.to]).distance / c.reach;
}

FaceModel contact_model(const Contact& c, const std::vector<Vec2>& uvs, bool stuck) {
  const Nearest near = nearest_on_edge(uvs[c.vertex], uvs[c.from], uvs[c.to]);
  const double x = near.distance / c.reach;
  FaceModel model{Vector6::Zero(), Matrix6::Zero()};
  if (!(x < 1 && near.outside > 0)) return model;
  // The curvature of the distance itself is left out: it is not positive.
  const Vector6 by_distance = distance_gradient(near);
  model.gradient = contact_term(c, near, uvs).gradient;
  const double across = stiffness_across(c, near);
  model.hessian.noalias() = (across * by_distance) * by_distance.transpose();
  if (stuck) {
    const Vec2 tangent(-near.apart.y() / near.distance, near.apart.x() / near.distance);
    Vector6 along;
    along << tangent, -(1 - near.share) * tangent, -near.share * tangent;
    model.hessian.noalias() += (across * along) * along.transpose();
  }
  return model;
}

}  // namespace beltrami
