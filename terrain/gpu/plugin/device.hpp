// What a kernel needs of a device: memory, launches, atomics on integers, stable sorts of integers. Compiled by nvcc it
// is CUDA; compiled by another compiler it is an emulation, in which a launch is a loop over the threads, forward,
// reversed or shuffled.
//
// A kernel is a struct of pointers and numbers with operator()(int thread). It contains no barrier, and threads share
// nothing but integer sums, largest and smallest values, whose results do not depend on an order. So every order of
// threads gives the same bits, and so do all devices: no product is fused with a sum (-fmad=false, -ffp-contract=off),
// roots and divisions are those of IEEE 754.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "protocol/core/host_device.hpp"
#include "terrain/gpu/gpu_interface.hpp"

namespace furrow::terrain::gpu {

using i32 = std::int32_t;
using u32 = std::uint32_t;
using i64 = std::int64_t;
using u64 = std::uint64_t;

/// Thrown inside the library only.
struct DeviceError {
  Status status;
  std::string text;
};

inline constexpr int kBlock = 128;  // threads

// ---- device code ------------------------------------------------------------------------------------------------

/// Nearest whole number; halves to the even one. @pre |v| < 2^62
FURROW_HD inline i64 nearest(double v) {
#ifdef __CUDA_ARCH__
  return __double2ll_rn(v);
#else
  return std::llrint(v);
#endif
}

FURROW_HD inline void atomic_max(u32* at, u32 v) {
#ifdef __CUDA_ARCH__
  if (v > *static_cast<volatile u32*>(at)) atomicMax(at, v);
#else
  if (v > *at) *at = v;
#endif
}
FURROW_HD inline void atomic_max(u64* at, u64 v) {
#ifdef __CUDA_ARCH__
  if (v > *static_cast<volatile u64*>(at))
    atomicMax(reinterpret_cast<unsigned long long*>(at), static_cast<unsigned long long>(v));
#else
  if (v > *at) *at = v;
#endif
}
FURROW_HD inline void atomic_min(u32* at, u32 v) {
#ifdef __CUDA_ARCH__
  if (v < *static_cast<volatile u32*>(at)) atomicMin(at, v);
#else
  if (v < *at) *at = v;
#endif
}
FURROW_HD inline void atomic_add(i64* at, i64 v) {
#ifdef __CUDA_ARCH__
  atomicAdd(reinterpret_cast<unsigned long long*>(at), static_cast<unsigned long long>(v));
#else
  *at = static_cast<i64>(static_cast<u64>(*at) + static_cast<u64>(v));
#endif
}

/// Bits of a number that is not negative: they rise with it.
FURROW_HD inline u32 bits_of(float v) {
  u32 bits;
  memcpy(&bits, &v, sizeof bits);
  return bits;
}
FURROW_HD inline u64 bits_of(double v) {
  u64 bits;
  memcpy(&bits, &v, sizeof bits);
  return bits;
}

// ---- the device -------------------------------------------------------------------------------------------------

class Device {
 public:
  /// @param order of threads in the emulation
  explicit Device(int order);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Calls kernel(thread) for 0 ≤ thread < count.
  template <class Kernel>
  void launch(i64 count, const Kernel& kernel);
  void wait();

  void* allocate(std::size_t bytes);
  void release(void* memory, std::size_t bytes) noexcept;
  void upload(void* to, const void* from, std::size_t bytes);
  void download(void* to, const void* from, std::size_t bytes);
  void copy(void* to, const void* from, std::size_t bytes);
  void clear(void* memory, std::size_t bytes);

  /// Sorts by keys; equal keys keep their order. Input and output are different arrays.
  void sort(const u32* keys, u32* sorted_keys, const u32* values, u32* sorted_values, int count, int bits);
  /// sums[k] = flags[0] + … + flags[k − 1]
  void exclusive_sums(const u32* flags, u32* sums, int count);

  i64 bytes() const { return bytes_; }

 private:
  void make_room(std::size_t bytes);

  int order_;
  i64 bytes_ = 0;
  void* stream_ = nullptr;
  void* scratch_ = nullptr;
  std::size_t scratch_bytes_ = 0;
};

DeviceInfo device_info();

/// An array in the memory of the device.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer() { free(); }

  /// Room for `count` entries; what it held is lost if it grows.
  T* reserve(Device& device, std::size_t count) {
    if (count <= size_) return at_;
    free();
    device_ = &device;
    at_ = static_cast<T*>(device.allocate(count * sizeof(T)));
    size_ = count;
    return at_;
  }
  T* data() const { return at_; }
  std::size_t size() const { return size_; }
  void put(Device& device, const T* from, std::size_t count) {
    reserve(device, count);
    if (count > 0) device.upload(at_, from, count * sizeof(T));
  }
  std::vector<T> get(Device& device, std::size_t count) const {
    std::vector<T> out(count);
    if (count > 0) device.download(out.data(), at_, count * sizeof(T));
    return out;
  }
  void swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(at_, other.at_);
    std::swap(size_, other.size_);
  }

 private:
  void free() noexcept {
    if (at_) device_->release(at_, size_ * sizeof(T));
    at_ = nullptr;
    size_ = 0;
  }
  Device* device_ = nullptr;
  T* at_ = nullptr;
  std::size_t size_ = 0;
};

#ifdef __CUDACC__

inline void check(cudaError_t error, const char* what) {
  if (error == cudaSuccess) return;
  const Status status = error == cudaErrorMemoryAllocation ? Status::memory
                        : error == cudaErrorNoDevice || error == cudaErrorInsufficientDriver ||
                                error == cudaErrorInitializationError || error == cudaErrorSystemDriverMismatch
                            ? Status::no_device
                            : Status::failed;
  throw DeviceError{status, std::string(what) + ": " + cudaGetErrorString(error)};
}

template <class Kernel>
__global__ void __launch_bounds__(kBlock) run_kernel(const Kernel kernel, int count) {
  const int thread = static_cast<int>(blockIdx.x) * kBlock + static_cast<int>(threadIdx.x);
  if (thread < count) kernel(thread);
}

template <class Kernel>
void Device::launch(i64 count, const Kernel& kernel) {
  if (count <= 0) return;
  const auto blocks = static_cast<unsigned>((count + kBlock - 1) / kBlock);
  run_kernel<<<blocks, kBlock, 0, static_cast<cudaStream_t>(stream_)>>>(kernel, static_cast<int>(count));
  check(cudaGetLastError(), "launch of a kernel");
}

#else

/// The thread that runs as the k-th of `count`. Shuffled: k → (k × stride + shift) mod count, with a stride that has no
/// divisor in common with count.
struct ThreadOrder {
  i64 count, stride, shift;
  ThreadOrder(int order, i64 n);
  i64 operator()(i64 k) const { return (k * stride + shift) % count; }
};

template <class Kernel>
void Device::launch(i64 count, const Kernel& kernel) {
  if (count <= 0) return;
  if (order_ == 0) {
    for (i64 k = 0; k < count; ++k) kernel(static_cast<int>(k));
    return;
  }
  const ThreadOrder order(order_, count);
  for (i64 k = 0; k < count; ++k) kernel(static_cast<int>(order(k)));
}

#endif

}  // namespace furrow::terrain::gpu
