#pragma once

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

// Replaces the allocation of a whole test program, so that a test can say when memory is short. For one file of a
// program: the operators below must not be defined twice.

namespace vantage::test {

/// Tells of an allocation's size whether it is refused; nothing is where it is not set.
inline std::atomic<bool (*)(std::size_t)> refuses_memory = nullptr;

inline void* allocate(std::size_t size) {
  const auto refuses = refuses_memory.load();
  if (refuses != nullptr && refuses(size)) throw std::bad_alloc();
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

}  // namespace vantage::test

void* operator new(std::size_t size) { return vantage::test::allocate(size); }
void* operator new[](std::size_t size) { return vantage::test::allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
