// Counts what a program takes from the heap. It defines operator new: include it in one file of a program.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace etendue::test {

inline std::size_t heap_held = 0, heap_most_held = 0;

// Bytes that `work` holds at most beyond what is held before.
template <class Work>
std::size_t peak_heap_of(const Work& work) {
  const std::size_t before = heap_held;
  heap_most_held = before;
  work();
  return heap_most_held - before;
}

struct alignas(std::max_align_t) HeapHeader {
  std::size_t size;
};

}  // namespace etendue::test

// Inlined, they mislead a warning of GCC: it sees memory that operator new gave freed inside its block.
[[gnu::noinline]] void* operator new(std::size_t size) {
  using namespace etendue::test;
  void* const memory = std::malloc(sizeof(HeapHeader) + size);
  if (memory == nullptr) throw std::bad_alloc();
  static_cast<HeapHeader*>(memory)->size = size;
  heap_held += size;
  heap_most_held = std::max(heap_most_held, heap_held);
  return static_cast<HeapHeader*>(memory) + 1;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  if (memory == nullptr) return;
  etendue::test::HeapHeader* const header = static_cast<etendue::test::HeapHeader*>(memory) - 1;
  etendue::test::heap_held -= header->size;
  std::free(header);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
