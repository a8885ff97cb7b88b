// OpenMesh's decimater (Kobbelt, Campagna, Seidel 1998, "A General Framework for Mesh Decimation")
// with its module of quadrics, held to the contract of simplify(). What must stay, what holds the
// boundary and how much worse a face may become are the same as in simplify_in_passes; the order of
// the collapses, their cost and the surface itself are OpenMesh's.
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Decimater/Observer.hh>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/coarse.h"
#include "simplify/quadric.h"
#include "simplify/shape.h"
#include "simplify/surface.h"

namespace beltrami {
namespace {

using Role = ShrinkingSurface::Role;

/// A vertex of more faces is neither moved nor moved onto: the decimater looks at all collapses of
/// a vertex whenever one in its ring has gone, which takes the square of its faces.
constexpr Index kMaxValence = 64;

// --- The surface --------------------------------------------------------------------------------

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  // Beyond the decimater, which asks for them, too: what is deleted, and what is locked before.
  VertexAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};

/// The surface as OpenMesh has it. Its handles are the indices of the fine mesh.
class Decimated : public OpenMesh::TriMesh_ArrayKernelT<Traits> {
 public:
  using Base = OpenMesh::TriMesh_ArrayKernelT<Traits>;

  /// Keeps a reference to the mesh. Throws Error INTERNAL if OpenMesh refuses a face.
  Decimated(const DiskMesh& fine, const Work& work);

  /// Replaces that of OpenMesh's mesh in the decimater, which asks when it lists a collapse and
  /// again when it is due: by then the boundary may have shrunk to its least, and faces be gone
  /// from the corners opposite the edge.
  bool is_collapse_ok(HalfedgeHandle edge);

  /// To be told of each collapse; the apexes are the corners opposite the edge, if valid.
  void note_collapse(VertexHandle from, VertexHandle to, VertexHandle left, VertexHandle right);

  const DiskMesh& fine() const { return fine_; }
  const Work& work() const { return work_; }
  Index live_faces() const { return live_faces_; }
  Index live_vertices() const { return live_vertices_; }
  /// Per fine vertex: the next one on the way, or itself.
  const std::vector<Index>& collapsed_into() const { return collapsed_into_; }

  // What keeps_shape asks.
  const Vec3& position(Index v) const { return fine_.positions[v]; }
  template <class Visit>
  void for_each_corner(Index v, Visit&& visit) const {
    for (const auto edge : voh_range(VertexHandle(v))) {
      if (is_boundary(edge)) continue;
      visit(face_handle(edge).idx(), 0, to_vertex_handle(edge).idx(),
            from_vertex_handle(prev_halfedge_handle(edge)).idx());
    }
  }

 private:
  Index min_valence(VertexHandle v) const { return fine_.on_boundary[v.idx()] ? 2 : 3; }
  bool keeps_valences(HalfedgeHandle edge) const;
  bool makes_bridge(HalfedgeHandle edge) const;

  const DiskMesh& fine_;
  const Work work_;
  Index live_faces_, live_vertices_, boundary_count_, min_boundary_;
  std::vector<Index> collapsed_into_;
  std::vector<Index> valence_;  // live faces per vertex
};

Decimated::Decimated(const DiskMesh& fine, const Work& work)
    : fine_(fine),
      work_(work),
      live_faces_(fine.face_count()),
      live_vertices_(fine.vertex_count()),
      boundary_count_(size_of(fine.boundary)),
      min_boundary_(least_boundary(size_of(fine.boundary))),
      collapsed_into_(fine.vertex_count()),
      valence_(fine.vertex_count()) {
  std::iota(collapsed_into_.begin(), collapsed_into_.end(), 0);
  reserve(fine.vertex_count(), fine.vertex_count() + fine.face_count(), fine.face_count());
  const std::vector<Role> roles = vertex_roles(fine, {fine.boundary});
  for (Index v = 0; v < fine.vertex_count(); ++v) {
    const Vec3& p = fine.positions[v];
    status(add_vertex({p.x(), p.y(), p.z()})).set_locked(roles[v] == Role::kFixedBoundary);
  }
  for (const Triangle& face : fine.faces) {
    poll_interrupt();
    for (const Index v : face) ++valence_[v];
    if (!add_face(VertexHandle(face[0]), VertexHandle(face[1]), VertexHandle(face[2])).is_valid()) {
      throw Error(Fault::kInternal, "OpenMesh takes a face for non-manifold, please report it");
    }
  }
}

/// Whether no vertex ends up with too few faces, and none has too many to look at.
bool Decimated::keeps_valences(HalfedgeHandle edge) const {
  const VertexHandle from = from_vertex_handle(edge), to = to_vertex_handle(edge);
  if (std::max(valence_[from.idx()], valence_[to.idx()]) > kMaxValence) return false;
  Index gone = 0;
  for (const HalfedgeHandle side : {edge, opposite_halfedge_handle(edge)}) {
    if (is_boundary(side)) continue;
    const VertexHandle apex = to_vertex_handle(next_halfedge_handle(side));
    if (valence_[apex.idx()] - 1 < min_valence(apex)) return false;
    ++gone;
  }
  return valence_[from.idx()] + valence_[to.idx()] - 2 * gone >= min_valence(to);
}

/// Whether an interior edge between boundary vertices would come up. A boundary vertex that may
/// move is no bridge end, so that its ring brings none along.
bool Decimated::makes_bridge(HalfedgeHandle edge) const {
  const VertexHandle from = from_vertex_handle(edge), to = to_vertex_handle(edge);
  if (is_boundary(from) || !is_boundary(to)) return false;
  const VertexHandle left = to_vertex_handle(next_halfedge_handle(edge));
  const VertexHandle right = to_vertex_handle(next_halfedge_handle(opposite_halfedge_handle(edge)));
  const auto ring = vv_range(from);
  return std::any_of(ring.begin(), ring.end(), [&](VertexHandle u) {
    return is_boundary(u) && u != to && u != left && u != right;
  });
}

bool Decimated::is_collapse_ok(HalfedgeHandle edge) {
  const bool shortens = is_boundary(from_vertex_handle(edge));
  if (shortens && boundary_count_ <= min_boundary_) return false;
  return keeps_valences(edge) && Base::is_collapse_ok(edge) && !makes_bridge(edge);
}

void Decimated::note_collapse(VertexHandle from, VertexHandle to, VertexHandle left,
                              VertexHandle right) {
  Index gone = 0;
  for (const VertexHandle apex : {left, right}) {
    if (!apex.is_valid()) continue;
    --valence_[apex.idx()];
    ++gone;
  }
  valence_[to.idx()] += valence_[from.idx()] - 2 * gone;
  collapsed_into_[from.idx()] = to.idx();
  live_faces_ -= gone;
  --live_vertices_;
  boundary_count_ -= fine_.on_boundary[from.idx()] ? 1 : 0;
}

// --- What collapses cost ------------------------------------------------------------------------

using PlainQuadrics = OpenMesh::Decimater::ModQuadricT<Decimated>;

/// OpenMesh's quadrics of the faces, with those that it lacks: of the boundary, which would shrink
/// for nothing where the surface is flat, and of faces without area. Refuses what ruins faces.
class Quadrics : public PlainQuadrics {
 public:
  using Handle = OpenMesh::Decimater::ModHandleT<Quadrics>;

  explicit Quadrics(Decimated& surface) : PlainQuadrics(surface) {}

  void set_limits(const ShapeLimits& limits) { limits_ = limits; }

  void initialize() override;
  float collapse_priority(const CollapseInfo& edge) override;
  void postprocess_collapse(const CollapseInfo& edge) override;

 private:
  using Quadric4 = OpenMesh::Geometry::Quadricd;

  ShapeLimits limits_ = kShapeLimits[0];
  std::vector<Quadric4> further_;  // per vertex
};

void Quadrics::initialize() {
  PlainQuadrics::initialize();
  const DiskMesh& fine = mesh().fine();
  further_.clear();
  further_.reserve(fine.positions.size());
  for (const Quadric& q : vertex_quadrics(fine, FacePlanes::kLeftOut, mesh().work())) {
    // From d'Ad of the offset d = x - p to a function of x.
    const Vec3& p = fine.positions[further_.size()];
    const double x = -(q.xx * p.x() + q.xy * p.y() + q.xz * p.z());
    const double y = -(q.xy * p.x() + q.yy * p.y() + q.yz * p.z());
    const double z = -(q.xz * p.x() + q.yz * p.y() + q.zz * p.z());
    const double constant = -(x * p.x() + y * p.y() + z * p.z());
    further_.emplace_back(q.xx, q.xy, q.xz, x, q.yy, q.yz, y, q.zz, z, constant);
  }
}

float Quadrics::collapse_priority(const CollapseInfo& edge) {
  poll_interrupt();
  if (!keeps_shape(mesh(), edge.v0.idx(), edge.v1.idx(), limits_)) return ILLEGAL_COLLAPSE;
  Quadric4 further = further_[edge.v0.idx()];
  further += further_[edge.v1.idx()];
  const auto error = PlainQuadrics::collapse_priority(edge) + static_cast<float>(further(edge.p1));
  return std::max(0.0f, error);  // rounding alone makes it negative, which would mean illegal
}

void Quadrics::postprocess_collapse(const CollapseInfo& edge) {
  PlainQuadrics::postprocess_collapse(edge);
  further_[edge.v1.idx()] += further_[edge.v0.idx()];
  mesh().note_collapse(edge.v0, edge.v1, edge.vl, edge.vr);
}

// --- The run ------------------------------------------------------------------------------------

/// Reports the progress, and the decimater when to stop.
class Watch : public OpenMesh::Decimater::Observer {
 public:
  Watch(const Decimated& surface, Index target_faces, const Work& work)
      : Observer(1), surface_(surface), target_(target_faces), work_(work) {}

  void notify(std::size_t step) override {
    if (step % kReportInterval == 0) report();
  }
  bool abort() const override { return surface_.live_faces() <= target_; }
  void report() const {
    const double start = surface_.fine().face_count();
    work_.report((start - surface_.live_faces()) / (start - target_));
  }

 private:
  static constexpr std::size_t kReportInterval = 100;  // collapses: some milliseconds

  const Decimated& surface_;
  Index target_;
  const Work& work_;
};

void decimate(Decimated& surface, Index target_faces, const Work& work) {
  OpenMesh::Decimater::DecimaterT<Decimated> decimater(surface);
  Quadrics::Handle quadrics;
  decimater.add(quadrics);
  decimater.initialize();
  Watch watch(surface, target_faces, work);
  decimater.set_observer(&watch);
  for (const ShapeLimits& limits : kShapeLimits) {
    decimater.module(quadrics).set_limits(limits);
    // Again while it helps: a vertex whose cheapest collapse is refused when it is due is dropped.
    std::size_t collapsed = 0, worthwhile = 0;
    do {
      if (watch.abort()) return;
      watch.report();
      worthwhile = 1 + static_cast<std::size_t>(limits.min_progress * surface.live_vertices());
      collapsed = decimater.decimate();
    } while (collapsed >= worthwhile);
  }
}

/// What is left, renumbered in order.
CoarseDisk collect(const DiskMesh& fine, const Decimated& surface, const Work& work) {
  std::vector<Index> fine_vertex, coarse_vertex(fine.positions.size(), kNone);
  for (const auto v : surface.vertices()) {
    coarse_vertex[v.idx()] = size_of(fine_vertex);
    fine_vertex.push_back(v.idx());
  }
  std::vector<Triangle> faces;
  for (const auto f : surface.faces()) {
    Triangle& face = faces.emplace_back();
    auto corner = surface.cfv_iter(f);
    for (Index& v : face) v = coarse_vertex[(corner++)->idx()];
  }
  return coarse_disk(fine, std::move(fine_vertex), std::move(faces), surface.collapsed_into(),
                     work);
}

/// The same around the origin, in a box of size 1: OpenMesh has quadrics about the origin, and
/// compares costs, fourth powers of lengths, in single precision. The scale is a power of two, so
/// that it changes no bit.
DiskMesh around_origin(DiskMesh mesh) {
  const Eigen::Map<const Eigen::Matrix3Xd> points(mesh.positions[0].data(), 3, mesh.vertex_count());
  const Vec3 low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  int exponent = 0;
  std::frexp((high - low).maxCoeff(), &exponent);
  const double scale = std::ldexp(1.0, -exponent);
  for (Vec3& p : mesh.positions) p = scale * (p - (low + 0.5 * (high - low)));
  return mesh;
}

}  // namespace

CoarseDisk simplify_by_openmesh(const DiskMesh& fine, Index target_faces, const Work& work) {
  if (target_faces >= fine.face_count()) return whole_disk(fine);
  const DiskMesh centred = around_origin(fine);
  Decimated surface(centred, work);
  decimate(surface, target_faces, work);
  return collect(fine, surface, work);
}

}  // namespace beltrami
