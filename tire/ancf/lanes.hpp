// Four doubles that are worked on at once: one lane per element of a batch around the ring. GCC and Clang
// vector extensions; without AVX the compiler splits them.
#pragma once

namespace furrow {

inline constexpr int kLanes = 4;

typedef double Lanes __attribute__((vector_size(8 * kLanes)));
typedef double UnalignedLanes __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));

inline Lanes load(const double* p) { return *reinterpret_cast<const UnalignedLanes*>(p); }
inline void store(double* p, Lanes v) { *reinterpret_cast<UnalignedLanes*>(p) = v; }
inline void add_to(double* p, Lanes v) { store(p, load(p) + v); }
inline Lanes spread(double s) { return Lanes{s, s, s, s}; }
/// In lane order, so that the same bits come out everywhere.
inline double sum(Lanes v) { return ((v[0] + v[1]) + v[2]) + v[3]; }

struct Lanes3 {
  Lanes x, y, z;
};
inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Lanes3 operator*(double s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes3 operator*(Lanes s, const Lanes3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes3& operator+=(Lanes3& a, const Lanes3& b) { return a = a + b; }
inline Lanes dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace furrow
