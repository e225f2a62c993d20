// SPDX-License-Identifier: Apache-2.0
// Replaces operator new, and malloc by the linker's --wrap.
#include "tests/codec/counted_memory.h"

#include <malloc.h>

#include <cstdlib>
#include <cstring>
#include <new>

extern "C" {
void* __real_malloc(std::size_t size);
void __real_free(void* memory);
}

namespace sac {

CountedMemory counted_memory;

namespace {

void* Allocate(std::size_t size, std::size_t alignment = 0) {
  CountedMemory& count = counted_memory;
  long left = count.until_failure;
  while (left > 0 && !count.until_failure.compare_exchange_weak(left, left - 1)) {
  }
  if (left == 0) {
    if (!count.fail_on) count.until_failure = -1;
    return nullptr;
  }
  ++count.allocations;
  void* const memory = alignment > 0 ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                                     : __real_malloc(size > 0 ? size : 1);
  if (memory) {
    ++count.living;
    const std::size_t bytes = count.bytes += malloc_usable_size(memory);
    std::size_t peak = count.peak_bytes;
    while (bytes > peak && !count.peak_bytes.compare_exchange_weak(peak, bytes)) {
    }
  }
  return memory;
}

void* AllocateOrThrow(std::size_t size, std::size_t alignment = 0) {
  void* const memory = Allocate(size, alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

void Release(void* memory) noexcept {
  if (!memory) return;
  --counted_memory.living;
  counted_memory.bytes -= malloc_usable_size(memory);
  __real_free(memory);
}

}  // namespace
}  // namespace sac

using sac::Allocate;
using sac::AllocateOrThrow;
using sac::Release;

extern "C" {
void* __wrap_malloc(std::size_t size) { return Allocate(size); }
void* __wrap_calloc(std::size_t count, std::size_t size) {
  void* const memory = size > 0 && count > static_cast<std::size_t>(-1) / size ? nullptr : Allocate(count * size);
  return memory ? std::memset(memory, 0, count * size) : nullptr;
}
void* __wrap_realloc(void* memory, std::size_t size) {
  void* const moved = Allocate(size);
  if (!moved || !memory) return moved;
  std::memcpy(moved, memory, std::min(size, malloc_usable_size(memory)));
  Release(memory);
  return moved;
}
void __wrap_free(void* memory) { Release(memory); }
}

void* operator new(std::size_t size) { return AllocateOrThrow(size); }
void* operator new[](std::size_t size) { return AllocateOrThrow(size); }
void* operator new(std::size_t size, std::align_val_t a) { return AllocateOrThrow(size, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t size, std::align_val_t a) {
  return AllocateOrThrow(size, static_cast<std::size_t>(a));
}
// For want of this memory std::stable_sort only gets slower.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return Allocate(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return Allocate(size); }
void operator delete(void* memory) noexcept { Release(memory); }
void operator delete[](void* memory) noexcept { Release(memory); }
void operator delete(void* memory, std::size_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { Release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { Release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { Release(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { Release(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { Release(memory); }
