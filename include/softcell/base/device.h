// SPDX-License-Identifier: LGPL-2.1-or-later
// Memory and kernels of a graphics card, or of the host in its place; no CUDA types.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace softcell
{
  // A kernel is a struct of numbers and of pointers into the memory of a device, with
  //   n_threads                        of a block
  //   min_blocks                       for which a multiprocessor has registers; it may be missing
  //   n_phases                         all threads of a block end a phase before the next one
  //   Scratch, n_scratch               type and number of what the threads of a block share
  //   operator()(phase, block, thread, scratch) const
  //                                    what a thread does, for host and device
  // Blocks, and threads within a phase, write to different places and do not read what others of
  // them write: their order does not matter.

  /// A graphics card. Its functions throw std::runtime_error with what CUDA has to say.
  struct Cuda
  {
    static bool is_there();
    /// @return zeros
    static void *allocate(std::size_t n_bytes);
    static void release(void *memory);
    /// Between any of host and device; waits for kernels.
    static void copy(void *to, const void *from, std::size_t n_bytes);

    template <class Kernel>
    static void launch(const Kernel &kernel, std::size_t n_blocks);

    /// Launches that are always the same, which start sooner one after another when they are known
    /// beforehand.
    class Recording
    {
    public:
      Recording()                             = default;
      Recording(const Recording &)            = delete;
      Recording &operator=(const Recording &) = delete;
      ~Recording();
      /// Does the work, which is nothing but launches; from the second time on, as recorded in the
      /// first.
      void run(const std::function<void()> &work);
      /// Forgets what is recorded.
      void clear();

    private:
      void *graph_ = nullptr;
    };
  };

  /// The host, which runs kernels block by block and thread by thread with the same arithmetic of
  /// indices.
  struct Serial
  {
    static bool is_there()
    {
      return true;
    }
    static void *allocate(std::size_t n_bytes);
    static void release(void *memory);
    static void copy(void *to, const void *from, std::size_t n_bytes);

    template <class Kernel>
    static void launch(const Kernel &kernel, std::size_t n_blocks);

    struct Recording
    {
      static void run(const std::function<void()> &work)
      {
        work();
      }
      static void clear() {}
    };
  };

  /// An array in the memory of a device.
  template <class T, class Device>
  class DeviceArray
  {
  public:
    DeviceArray() = default;
    /// Zeros.
    explicit DeviceArray(const std::size_t size)
        : data_(static_cast<T *>(Device::allocate(size * sizeof(T)))), size_(size)
    {
    }
    explicit DeviceArray(const std::vector<T> &values) : DeviceArray(values.size())
    {
      copy_from(values.data());
    }

    T *data() const
    {
      return data_.get();
    }
    std::size_t size() const
    {
      return size_;
    }
    /// @param host (size())
    void copy_from(const T *host)
    {
      Device::copy(data(), host, size_ * sizeof(T));
    }
    /// @param host (size())
    void copy_to(T *host) const
    {
      Device::copy(host, data(), size_ * sizeof(T));
    }
    void copy_from(const DeviceArray &other)
    {
      Device::copy(data(), other.data(), size_ * sizeof(T));
    }

  private:
    struct Release
    {
      void operator()(T *memory) const
      {
        Device::release(memory);
      }
    };
    std::unique_ptr<T, Release> data_;
    std::size_t size_ = 0;
  };
} // namespace softcell
