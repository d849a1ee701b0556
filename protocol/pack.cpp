// A message is packed as its fields in the order of its list.
#include "protocol/contact_statement.hpp"
#include "protocol/core/byte_stream.hpp"
#include "protocol/transport.hpp"

namespace furrow {

template <class M>
std::vector<std::byte> pack(const M& message) {
  ByteWriter writer;
  writer(message);
  return writer.take();
}

template <class M>
M unpack(const std::vector<std::byte>& payload) {
  M message;
  ByteReader reader(payload);
  reader(message);
  reader.finish();
  return message;
}

#define FURROW_MESSAGE(M)                            \
  template std::vector<std::byte> pack<M>(const M&); \
  template M unpack<M>(const std::vector<std::byte>&);
FURROW_MESSAGE(NodeCard)
FURROW_MESSAGE(SurfaceSetup)
FURROW_MESSAGE(TerrainSetup)
FURROW_MESSAGE(RimMotion)
FURROW_MESSAGE(SpindleReport)
FURROW_MESSAGE(SurfaceMotion)
FURROW_MESSAGE(ContactStatement)
FURROW_MESSAGE(PromptWrench)
FURROW_MESSAGE(TerrainForces)
FURROW_MESSAGE(TerrainReport)
FURROW_MESSAGE(FinalReport)
FURROW_MESSAGE(CheckpointPart)
FURROW_MESSAGE(RunFolder)
#undef FURROW_MESSAGE

}  // namespace furrow
