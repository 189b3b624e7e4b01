// SPDX-License-Identifier: LGPL-2.1-or-later
// The body that chosen labels of a segmentation form.
#pragma once

#include <softcell/geometry/image.h>
#include <softcell/geometry/shape.h>

namespace softcell
{
  /// The union of the voxels of some labels.
  ///
  /// Inside, classification and filled volume answer exactly for these voxels, boxes in constant
  /// time from summed-volume tables of 4 bytes a voxel of the body's bounding box: one, and one
  /// more each time that the number of labels doubles.
  ///
  /// Only surface() smooths: it is a level set of the voxels blurred by a Gaussian of
  /// sigma = 1.5 times the coarsest voxel spacing (or 1/150 of the bounding box's diagonal, if that
  /// is more), at the level that encloses the voxels' volume, clamped to their bounding box, which
  /// may cost 1e-3 of the volume. Where the boundary has the radius of curvature R, it moves by
  /// about sigma^2 / R; edges are rounded by about sigma, and details narrower than 2 sigma are
  /// lost.
  class ImageBody final : public Shape
  {
  public:
    /// Pieces that hang together by no voxel face with the rest and have less than a thousandth of
    /// the largest piece's voxels are left out.
    /// @param labels  values that form the body, in the order in which label() counts them; empty:
    /// all but 0,
    ///                ascending.
    /// @param name    of the image, for messages.
    /// @param remarks gets a sentence on pieces left out or apart.
    /// @throws BadInput if there is no voxel of one of the labels.
    ImageBody(LabelImage image,
              const std::vector<unsigned int> &labels,
              const std::string &name,
              std::vector<std::string> &remarks);

    Box bounding_box() const override;
    bool contains(const Point &X) const override;
    Side classify(const Box &box) const override;
    double filled_volume(const Box &box) const override;
    double volume() const override;

    unsigned int n_labels() const override;
    unsigned int label(const Point &X) const override;
    std::string label_name(unsigned int label) const override;

  private:
    using Index = std::array<unsigned int, 3>;
    /// (size + 1): how many of some voxels lie below, behind and left of a corner.
    using Sums = std::vector<std::uint32_t>;

    /// A range of real numbers in units of voxels.
    struct Range
    {
      double low, high;
    };

    Surface make_surface() const override;
    /// The box in units of voxels from the body's lower corner; nearly whole numbers are made
    /// whole.
    std::array<Range, 3> in_voxels(const Box &box) const;
    /// Sums of the voxels that `counts` is true of.
    template <class Counts>
    Sums sum_up(const Counts &counts) const;
    /// How many of the summed voxels have indices in [low, high).
    std::uint32_t count(const Sums &sums, const Index &low, const Index &high) const;
    /// The label of a voxel + 1; 0 outside.
    std::uint8_t at(long i, long j, long k) const;

    Index size_;  // of the body's bounding box
    Point lower_; // corner of the first voxel
    Direction spacing_;
    std::vector<std::string> names_;   // of the labels
    std::vector<std::uint8_t> labels_; // one per voxel, x fastest: 0 outside, else label + 1
    Sums filled_;                      // of the body's voxels
    std::vector<Sums> with_bit_;       // of those with the first, second, ... bit of label() set
  };
} // namespace softcell
