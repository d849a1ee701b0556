// Vectors and matrices as saved state holds them: their numbers one after another, a matrix column by column.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/vec.hpp"

namespace furrow {

/// Adds the numbers of each matrix to `flat`.
template <class... Matrices>
void append_numbers(std::vector<double>& flat, const Matrices&... matrices) {
  (flat.insert(flat.end(), matrices.data(), matrices.data() + matrices.size()), ...);
}

/// Takes the numbers of each matrix as append_numbers has added them. @returns where the next ones begin
/// @pre as many stand there
template <class... Matrices>
const double* take_numbers(const double* from, Matrices&... matrices) {
  FURROW_ASSERT(from != nullptr);
  ((std::copy_n(from, matrices.size(), matrices.data()), from += matrices.size()), ...);
  return from;
}

/// Vectors or matrices of one fixed size, as one array.
template <class Matrix>
void put_flat(Archive& archive, const std::string& name, const std::vector<Matrix>& values) {
  std::vector<double> flat;
  flat.reserve(Matrix::SizeAtCompileTime * values.size());
  for (const Matrix& one : values) append_numbers(flat, one);
  archive.put(name, flat);
}

/// What put_flat has put. @throws Error(io) unless there are `count` of them
template <class Matrix>
std::vector<Matrix> get_flat(const Archive& archive, const std::string& name, std::size_t count) {
  const double* from = archive.get<double>(name, Matrix::SizeAtCompileTime * count).data();
  std::vector<Matrix> values(count);
  for (Matrix& one : values) from = take_numbers(from, one);
  return values;
}
/// As many as there are.
template <class Matrix>
std::vector<Matrix> get_flat(const Archive& archive, const std::string& name) {
  return get_flat<Matrix>(archive, name, archive.get<double>(name).size() / Matrix::SizeAtCompileTime);
}

}  // namespace furrow
