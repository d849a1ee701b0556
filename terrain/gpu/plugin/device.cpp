#include "terrain/gpu/plugin/device.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <numeric>

#ifdef __CUDACC__
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#endif

namespace furrow::terrain::gpu {

#ifdef __CUDACC__

namespace {
cudaStream_t as_stream(void* stream) { return static_cast<cudaStream_t>(stream); }
}  // namespace

DeviceInfo device_info() {
  int count = 0;
  check(cudaGetDeviceCount(&count), "no GPU can be used");
  if (count == 0) throw DeviceError{Status::no_device, "no GPU can be used: the driver finds none"};
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, 0), "properties of the GPU");
  DeviceInfo info{};
  std::snprintf(info.name, sizeof info.name, "%s", properties.name);
  check(cudaDriverGetVersion(&info.driver), "version of the driver");
  check(cudaRuntimeGetVersion(&info.runtime), "version of CUDA");
  info.memory = static_cast<i64>(properties.totalGlobalMem);
  return info;
}

Device::Device(int order) : order_(order) {
  device_info();  // says why there is no device
  // A thread that spins while it waits would take the tire's core.
  if (const cudaError_t error = cudaSetDeviceFlags(cudaDeviceScheduleBlockingSync);
      error != cudaErrorSetOnActiveProcess)  // of an engine made earlier
    check(error, "settings of the GPU");
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "start of the GPU");
  stream_ = stream;
}

Device::~Device() {
  if (scratch_) release(scratch_, scratch_bytes_);
  if (stream_) cudaStreamDestroy(as_stream(stream_));
}

void Device::wait() { check(cudaStreamSynchronize(as_stream(stream_)), "the GPU failed"); }

void* Device::allocate(std::size_t bytes) {
  void* memory = nullptr;
  check(cudaMalloc(&memory, bytes), ("memory of the GPU, " + std::to_string(bytes) + " bytes").c_str());
  bytes_ += static_cast<i64>(bytes);
  return memory;
}
void Device::release(void* memory, std::size_t bytes) noexcept {
  cudaFree(memory);
  bytes_ -= static_cast<i64>(bytes);
}
void Device::upload(void* to, const void* from, std::size_t bytes) {
  // From memory that is not pinned this returns once `from` may change.
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, as_stream(stream_)), "copy to the GPU");
}
void Device::download(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, as_stream(stream_)), "copy from the GPU");
  wait();
}
void Device::copy(void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, as_stream(stream_)), "copy in the GPU");
}
void Device::clear(void* memory, std::size_t bytes) {
  check(cudaMemsetAsync(memory, 0, bytes, as_stream(stream_)), "clearing of memory in the GPU");
}

void Device::make_room(std::size_t bytes) {
  if (bytes <= scratch_bytes_) return;
  if (scratch_) release(scratch_, scratch_bytes_);
  scratch_ = nullptr, scratch_bytes_ = 0;
  scratch_ = allocate(bytes);
  scratch_bytes_ = bytes;
}

void Device::sort(const u32* keys, u32* sorted_keys, const u32* values, u32* sorted_values, int count, int bits) {
  std::size_t bytes = 0;
  const auto go = [&](void* scratch) {
    check(cub::DeviceRadixSort::SortPairs(scratch, bytes, keys, sorted_keys, values, sorted_values, count, 0, bits,
                                          as_stream(stream_)),
          "sort in the GPU");
  };
  go(nullptr);
  make_room(std::max<std::size_t>(bytes, 1));
  go(scratch_);
}

void Device::exclusive_sums(const u32* flags, u32* sums, int count) {
  std::size_t bytes = 0;
  const auto go = [&](void* scratch) {
    check(cub::DeviceScan::ExclusiveSum(scratch, bytes, flags, sums, count, as_stream(stream_)), "sums in the GPU");
  };
  go(nullptr);
  make_room(std::max<std::size_t>(bytes, 1));
  go(scratch_);
}

#else

DeviceInfo device_info() {
  DeviceInfo info{};
  std::snprintf(info.name, sizeof info.name, "emulation on the processor");
  info.emulated = 1;
  return info;
}

ThreadOrder::ThreadOrder(int order, i64 n) : count(n), stride(order == 1 ? n - 1 : n * 5 / 8 + 1), shift(n - 1) {
  while (std::gcd(stride, count) != 1) ++stride;
}

Device::Device(int order) : order_(order) {}
Device::~Device() { release(scratch_, scratch_bytes_); }
void Device::wait() {}

void* Device::allocate(std::size_t bytes) {
  void* const memory = std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (!memory) throw DeviceError{Status::memory, "memory for the emulation, " + std::to_string(bytes) + " bytes"};
  std::memset(memory, 0xff, bytes);  // nothing may rely on what new memory holds
  bytes_ += static_cast<i64>(bytes);
  return memory;
}
void Device::release(void* memory, std::size_t bytes) noexcept {
  std::free(memory);
  bytes_ -= static_cast<i64>(bytes);
}
void Device::upload(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
void Device::download(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
void Device::copy(void* to, const void* from, std::size_t bytes) { std::memcpy(to, from, bytes); }
void Device::clear(void* memory, std::size_t bytes) { std::memset(memory, 0, bytes); }
void Device::make_room(std::size_t) {}

void Device::sort(const u32* keys, u32* sorted_keys, const u32* values, u32* sorted_values, int count, int) {
  std::vector<u32> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](u32 a, u32 b) { return keys[a] < keys[b]; });
  for (int k = 0; k < count; ++k) sorted_keys[k] = keys[order[k]], sorted_values[k] = values[order[k]];
}

void Device::exclusive_sums(const u32* flags, u32* sums, int count) {
  std::exclusive_scan(flags, flags + count, sums, 0U);
}

#endif

}  // namespace furrow::terrain::gpu
