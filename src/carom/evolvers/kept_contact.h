#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/world.h"

namespace carom {

/// A contact that is kept closed: ball a and ball b, or ball a and plane b.
template <int Dim>
struct KeptContact {
  std::uint32_t a;
  std::uint32_t b;
  bool wall;
  Vec<Dim> normal;                   ///< unit; from a to b, or from the plane to ball a
  double friction = 0.0;             ///< μ
  double least = 0.0;                ///< what u_n may not fall below, in the unit of u
  Vec<Dim> slip = Vec<Dim>::Zero();  ///< unit direction in which the contact slides; zero where it may stick
  double push = 0.0;  ///< λ >= 0 along the normal, kg × the unit of u: on b, or on a from a plane
  Vec<Dim> drag = Vec<Dim>::Zero();  ///< the tangential part
};

/// Columns: the normal, and unit vectors along the surface.
template <int Dim>
using Frame = Eigen::Matrix<double, Dim, Dim>;

template <int Dim>
Frame<Dim> frame_of(const KeptContact<Dim>& contact) {
  Frame<Dim> frame;
  frame.col(0) = contact.normal;
  frame.col(1) = contact.normal.unitOrthogonal();
  if constexpr (Dim == 3) frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

/// B of complementarity.h and of cone.h: what a unit of impulse along each direction of each contact does
/// to the balls, weighted by the root of how they respond.
/// @tparam kColumns  1: along the normals alone; Dim: along the surfaces too
template <int kColumns, int Dim, class Response>
Eigen::SparseMatrix<double> directions_of(const std::vector<KeptContact<Dim>>& contacts,
                                          const World<Dim>& world, const Response& response) {
  constexpr int kRows = kColumns > 1 ? Dim + kSpinAxes<Dim> : Dim;
  std::vector<std::uint32_t> balls;
  for (const KeptContact<Dim>& contact : contacts) {
    balls.push_back(contact.a);
    if (!contact.wall) balls.push_back(contact.b);
  }
  // By their numbers, so that sums do not depend on where balls stand in memory.
  const auto before = [&world](std::uint32_t a, std::uint32_t b) { return world.before(a, b); };
  std::sort(balls.begin(), balls.end(), before);
  balls.erase(std::unique(balls.begin(), balls.end()), balls.end());
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index column, std::uint32_t ball, const KeptContact<Dim>& contact, double sign,
                       const Vec<Dim>& direction) {
    const auto row = kRows * (std::lower_bound(balls.begin(), balls.end(), ball, before) - balls.begin());
    const Vec<Dim> moved = (sign * std::sqrt(response(ball))) * direction;
    for (int axis = 0; axis < Dim; ++axis) entries.emplace_back(row + axis, column, moved[axis]);
    if constexpr (kColumns > 1) {
      const Vec<Dim> arm = -world.radius[ball] * contact.normal;
      const Spin<Dim> spun = std::sqrt(world.inverse_inertia[ball]) * moment<Dim>(arm, direction);
      for (int axis = 0; axis < kSpinAxes<Dim>; ++axis) {
        entries.emplace_back(row + Dim + axis, column, spun[axis]);
      }
    }
  };
  const auto count = static_cast<Eigen::Index>(contacts.size());
  for (Eigen::Index column = 0; column < kColumns * count; ++column) {
    const KeptContact<Dim>& contact = contacts[static_cast<std::size_t>(column / kColumns)];
    const Vec<Dim> direction = frame_of<Dim>(contact).col(column % kColumns);
    add(column, contact.a, contact, contact.wall ? 1.0 : -1.0, direction);
    if (!contact.wall) add(column, contact.b, contact, 1.0, direction);
  }
  Eigen::SparseMatrix<double> matrix(kRows * static_cast<Eigen::Index>(balls.size()), kColumns * count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace carom
