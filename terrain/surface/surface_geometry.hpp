// Geometry of SurfaceCollider: the point of a triangle closest to a given point, and the shares of the contact law at
// several touched points of one sphere.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "protocol/core/vec.hpp"

namespace furrow::terrain {

/// The feature of triangle (a, b, c) that is closest. Edge k runs from vertex k to vertex k+1.
enum class TriangleRegion : std::uint8_t { face, edge_0, edge_1, edge_2, vertex_0, vertex_1, vertex_2 };

struct TrianglePoint {
  Vec3 point = Vec3::Zero();       // m
  std::array<double, 3> weight{};  // barycentric, each ≥ 0, sum 1
  TriangleRegion region = TriangleRegion::face;
};

/// Point of triangle (a, b, c) closest to p, by the Voronoi regions of its features
/// [Ericson, Real-Time Collision Detection, 2005, §5.1.5]. @pre the triangle has an area
TrianglePoint closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

inline constexpr int kMaxCandidates = 16;

/// Multipliers λ ≥ 0 of the shortest push-out D = Σ λ_i n_i with D·n_i ≥ δ_i: the complementarity problem
///
///   w = G λ − δ ≥ 0,  λ ≥ 0,  λ·w = 0,     G_ij = max(0, n_i·n_j) + ε [i = j],  ε = 1e-12.
///
/// Walls that face each other (n_i·n_j < 0) do not affect each other, so λ_i ≤ δ_i always. ε makes λ unique when
/// normals are linearly dependent. Active-set method of [Lawson & Hanson, Solving Least Squares Problems, 1974, ch.
/// 23], exact while G is definite: always if no two walls face each other. Otherwise a wall that the method cannot
/// place is left out. `overlap` may have any order, with all values > 0 and size ≤ kMaxCandidates. Returns the number
/// of λ_i > 0.
/// @pre all three spans have one size, at most kMaxCandidates
int solve_push_out(std::span<const Vec3> normal, std::span<const double> overlap, std::span<double> lambda);

/// Overlap that the contact law gets for each candidate. λ is not unique where more than three walls meet in a shallow
/// pit, and a nonlinear law would make its choice noticeable. So walls of nearly one direction share the depth of the
/// deepest of them:  δ̂_i = max_j [δ_i + w(n_i·n_j) max(0, δ_j − δ_i)],  w = 1 up to 45° apart, 0 from 73°.
void share_depth(std::span<const Vec3> normal, std::span<const double> overlap, std::span<double> shared);

}  // namespace furrow::terrain
