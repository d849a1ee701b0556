// The ranks that compute one model together, as that model sees them: their numbers, and the data that they exchange.
// protocol/transport_group.hpp sends the data; a parallel library of the model uses the communicator.
//
// All ranks of the group make every call, in the same order. A call ends with PeerFailure if a rank of the group fails
// or falls silent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace furrow {

class RankGroup {
 public:
  using Bytes = std::vector<std::byte>;

  virtual ~RankGroup() = default;

  virtual int rank() const = 0;  // 0: the leader, which speaks for all
  virtual int size() const = 0;

  /// @returns the leader's bytes, on every rank; the bytes of the others are ignored
  virtual Bytes broadcast(Bytes bytes) = 0;
  /// @returns on the leader the bytes of each rank, in their order; nothing on the others
  virtual std::vector<Bytes> gather(Bytes bytes) = 0;

  /// The group's own communicator, as MPI_Comm_f2c takes it; none if ranks are threads of one process.
  virtual std::optional<int> communicator() const { return std::nullopt; }
};

/// The values of all ranks, one rank after another in rank order; the same on every rank.
template <class T>
requires std::is_trivially_copyable_v<T> std::vector<T> gather_on_all(RankGroup& group, std::span<const T> own) {
  const auto* from = reinterpret_cast<const std::byte*>(own.data());
  RankGroup::Bytes all;
  for (const RankGroup::Bytes& part : group.gather({from, from + own.size_bytes()}))
    all.insert(all.end(), part.begin(), part.end());
  all = group.broadcast(std::move(all));
  std::vector<T> values(all.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), all.data(), values.size() * sizeof(T));
  return values;
}

/// Largest share of a rank over the mean share, minus 1; 0 if all shares are 0.
inline double imbalance(std::span<const std::int64_t> shares) {
  const std::int64_t all = std::accumulate(shares.begin(), shares.end(), std::int64_t{0});
  if (all == 0) return 0.0;
  const std::int64_t most = *std::max_element(shares.begin(), shares.end());
  return static_cast<double>(most) * static_cast<double>(shares.size()) / static_cast<double>(all) - 1.0;
}

}  // namespace furrow
