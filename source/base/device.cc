// SPDX-License-Identifier: LGPL-2.1-or-later
// The host in the place of a graphics card.

#include <softcell/base/device.h>

#include <cstdlib>
#include <cstring>
#include <new>

namespace softcell
{
  void *Serial::allocate(const std::size_t n_bytes)
  {
    void *const memory = std::calloc(n_bytes + 1, 1);
    if (memory == nullptr)
      throw std::bad_alloc();
    return memory;
  }

  void Serial::release(void *const memory)
  {
    std::free(memory);
  }

  void Serial::copy(void *const to, const void *const from, const std::size_t n_bytes)
  {
    std::memcpy(to, from, n_bytes);
  }
} // namespace softcell
