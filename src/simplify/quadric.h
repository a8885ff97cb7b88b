// The error quadric of Garland & Heckbert 1997, kept in the frame of its own vertex.
#pragma once

#include "base/vectors.h"

namespace beltrami {

/// Weighted sum of squared distances to planes, as a function of the offset d from the vertex that
/// owns it: d'Ad + 2 b'd, relative to the error at the vertex itself, which its owner keeps. With
/// the origin at the vertex the planes of its own faces have b = 0 exactly, so nothing cancels
/// however far the mesh lies from the origin.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< A, symmetric
  double bx = 0, by = 0, bz = 0;

  /// Adds a plane through the owner. `normal` is a unit vector.
  void add_plane(const Vec3& normal, double weight) {
    const Vec3 n = weight * normal;
    xx += n.x() * normal.x();
    xy += n.x() * normal.y();
    xz += n.x() * normal.z();
    yy += n.y() * normal.y();
    yz += n.y() * normal.z();
    zz += n.z() * normal.z();
  }

  /// Adds the owner's own place: the squared distance from it.
  void add_point(double weight) {
    xx += weight;
    yy += weight;
    zz += weight;
  }

  /// The sum of the weights, since every unit normal adds its weight to the trace.
  double weight() const { return xx + yy + zz; }

  /// The error at the offset d less the error at the owner: it can be negative.
  double change(const Vec3& d) const {
    return d.x() * (xx * d.x() + 2 * (xy * d.y() + xz * d.z() + bx)) +
           d.y() * (yy * d.y() + 2 * (yz * d.z() + by)) + d.z() * (zz * d.z() + 2 * bz);
  }

  /// The same function seen from an owner at the offset d.
  Quadric seen_from(const Vec3& d) const {
    Quadric moved = *this;
    moved.bx += xx * d.x() + xy * d.y() + xz * d.z();
    moved.by += xy * d.x() + yy * d.y() + yz * d.z();
    moved.bz += xz * d.x() + yz * d.y() + zz * d.z();
    return moved;
  }

  Quadric& operator+=(const Quadric& other) {
    xx += other.xx;
    xy += other.xy;
    xz += other.xz;
    yy += other.yy;
    yz += other.yz;
    zz += other.zz;
    bx += other.bx;
    by += other.by;
    bz += other.bz;
    return *this;
  }
};

}  // namespace beltrami
