// SPDX-License-Identifier: LGPL-2.1-or-later
// Rows that may change without moving the others.
#pragma once

#include <softcell/operators/flat_arrays.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace softcell
{
  /// Numbers with a gradient each, in rows of different lengths.
  ///
  /// Rows are kept in batches of `width`, one beside the other; a batch has room for its longest
  /// row and `spare` entries more. Entries that only fill up are 0. Source: Magnoux fig. 6.3.
  template <class Real>
  class PaddedRows
  {
  public:
    PaddedRows(const unsigned int width, const unsigned int spare) : width_(width), spare_(spare) {}

    unsigned int width() const
    {
      return width_;
    }
    std::size_t n_batches() const
    {
      return lengths_.size();
    }
    RowArrays<Real> arrays() const
    {
      return {n_batches(), starts_.data(), lengths_.data(), numbers_.data(), gradients_.data()};
    }
    /// Units: byte
    std::size_t memory() const
    {
      return (starts_.size() + lengths_.size() + row_lengths_.size() + numbers_.size()) *
               sizeof(unsigned int) +
             gradients_.size() * sizeof(Real);
    }

    unsigned int length(const std::size_t row) const
    {
      return row_lengths_[row];
    }
    unsigned int room(const std::size_t row) const
    {
      return starts_[row / width_ + 1] - starts_[row / width_];
    }
    bool has(const std::size_t row, const unsigned int number) const
    {
      return find(row, number) < length(row);
    }

    /// Adds a batch of empty rows with room for `length` entries and spare ones.
    void add_batch(const unsigned int length)
    {
      lengths_.push_back(0);
      row_lengths_.resize(row_lengths_.size() + width_, 0);
      is_changed_.resize(row_lengths_.size(), false);
      starts_.push_back(starts_.back());
      make_room(length);
    }

    /// Gives the last batch room for rows of `length` entries and spare ones.
    void make_room(const unsigned int length)
    {
      starts_.back() = std::max(starts_.back(), starts_.end()[-2] + length + spare_);
      numbers_.resize(std::size_t(starts_.back()) * width_, 0);
      gradients_.resize(std::size_t(starts_.back()) * 3 * width_, Real(0));
    }

    /// Adds an entry to a row that has room.
    /// @param gradient  (3), `stride` from one to the next.
    void append(const std::size_t row,
                const unsigned int number,
                const Real *const gradient,
                const std::size_t stride = 1)
    {
      const unsigned int k   = row_lengths_[row]++;
      lengths_[row / width_] = std::max(lengths_[row / width_], k + 1);
      write(row, k, number, gradient, stride);
    }

    /// Takes an entry out of a row, if it is there; its last one takes the place.
    void remove(const std::size_t row, const unsigned int number)
    {
      const unsigned int k = find(row, number);
      if (k == length(row))
        return;
      const Real zero[3]      = {};
      const unsigned int last = --row_lengths_[row];
      write(row, k, numbers_[entry(row, last)], &gradients_[gradient(row, last)], width_);
      write(row, last, 0, zero, 1);
    }

    /// Calls f(number) for the entries of a row, which are taken out.
    template <class F>
    void clear(const std::size_t row, const F &f)
    {
      while (length(row) > 0)
      {
        const unsigned int number = numbers_[entry(row, length(row) - 1)];
        remove(row, number);
        f(number);
      }
    }

    /// Adds the rows that were changed since the last call.
    /// @param weights  of points, null for nodes.
    void take_changes(RowChanges<Real> &changes, const Real *const weights)
    {
      for (const std::size_t row : changed_)
      {
        const std::size_t batch = row / width_;
        changes.rows.push_back({row, starts_[batch], lengths_[batch], room(row),
                                static_cast<unsigned int>(changes.numbers.size()),
                                weights != nullptr, weights != nullptr ? weights[row] : Real(0)});
        for (unsigned int k = 0; k < room(row); ++k)
        {
          changes.numbers.push_back(numbers_[entry(row, k)]);
          for (unsigned int d = 0; d < 3; ++d)
            changes.gradients.push_back(gradients_[gradient(row, k) + d * width_]);
        }
      }
      forget_changes();
    }

    void forget_changes()
    {
      for (const std::size_t row : changed_)
        is_changed_[row] = false;
      changed_.clear();
    }

  private:
    std::size_t entry(const std::size_t row, const unsigned int k) const
    {
      return std::size_t(starts_[row / width_] + k) * width_ + row % width_;
    }
    /// Of the gradient's first component.
    std::size_t gradient(const std::size_t row, const unsigned int k) const
    {
      return std::size_t(starts_[row / width_] + k) * 3 * width_ + row % width_;
    }
    unsigned int find(const std::size_t row, const unsigned int number) const
    {
      unsigned int k = 0;
      while (k < length(row) && numbers_[entry(row, k)] != number)
        ++k;
      return k;
    }
    void write(const std::size_t row,
               const unsigned int k,
               const unsigned int number,
               const Real *const gradient,
               const std::size_t stride)
    {
      numbers_[entry(row, k)] = number;
      for (unsigned int d = 0; d < 3; ++d)
        gradients_[this->gradient(row, k) + d * width_] = gradient[d * stride];
      if (!is_changed_[row])
        changed_.push_back(row);
      is_changed_[row] = true;
    }

    unsigned int width_, spare_;
    std::vector<unsigned int> starts_ = {0}, lengths_, row_lengths_, numbers_;
    dealii::AlignedVector<Real> gradients_;
    std::vector<std::size_t> changed_; // rows
    std::vector<bool> is_changed_;     // (rows)
  };
} // namespace softcell
