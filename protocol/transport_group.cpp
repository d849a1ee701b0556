#include "protocol/transport_group.hpp"

#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow {
namespace {

class TransportGroup final : public RankGroup {
 public:
  explicit TransportGroup(Transport& transport) : transport_(transport) {
    FURROW_ASSERT(transport.self().role == Role::terrain, to_string(transport.self()));
  }

  int rank() const override { return transport_.self().index; }
  int size() const override { return transport_.terrain_ranks(); }
  std::optional<int> communicator() const override { return transport_.role_communicator(); }

  Bytes broadcast(Bytes bytes) override {
    if (rank() > 0) return transport_.receive(member(0), MessageKind::group);
    for (int k = 1; k < size(); ++k) transport_.send(member(k), MessageKind::group, bytes);
    transport_.flush();
    return bytes;
  }

  std::vector<Bytes> gather(Bytes bytes) override {
    std::vector<Bytes> parts;
    if (rank() > 0) {
      transport_.send(member(0), MessageKind::group, std::move(bytes));
      transport_.flush();
      return parts;
    }
    parts.push_back(std::move(bytes));
    for (int k = 1; k < size(); ++k) parts.push_back(transport_.receive(member(k), MessageKind::group));
    return parts;
  }

 private:
  static Address member(int k) { return {Role::terrain, k}; }

  Transport& transport_;
};

}  // namespace

std::shared_ptr<RankGroup> make_terrain_group(Transport& transport) {
  if (transport.self().role != Role::terrain || transport.terrain_ranks() == 1) return nullptr;
  return std::make_shared<TransportGroup>(transport);
}

}  // namespace furrow
