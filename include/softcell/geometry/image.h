// SPDX-License-Identifier: LGPL-2.1-or-later
// Labelled segmentations: what a file of voxels says, whatever its format.
#pragma once

#include <softcell/base/types.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace softcell
{
  /// A box of voxels with their labels. Voxel (i, j, k) fills the box of size `spacing` centred at
  /// origin + (i, j, k) * spacing.
  struct LabelImage
  {
    std::array<unsigned int, 3> size = {{0, 0, 0}};
    Point origin;                     // Units: m
    Direction spacing;                // > 0. Units: m
    std::vector<std::int64_t> values; // the labels as the file has them, at most 255 of them
    std::vector<std::uint8_t> voxels; // x fastest; each an index into values
  };

  /// Reads INRIMAGE-4 (.inr, .inr.gz), MetaImage (.mha, .mhd), NRRD (.nrrd, .nhdr) and NIfTI-1
  /// (.nii, .nii.gz) images of integers, raw or compressed with zlib or gzip.
  ///
  /// Coordinates are those that the file states for its voxels, in the frame that DICOM and ITK
  /// use: where a file says how it lies in the patient, x points to the left, y to the back and z
  /// to the head; NIfTI's x and y are turned round therefore. Without such a statement the first
  /// voxel's centre is the origin. The image's axes may be flipped and exchanged but not oblique.
  ///
  /// @param scale factor from the file's unit to metres.
  /// @throws BadInput for a file that is missing, cut short, damaged, oblique, not of integers or
  /// no segmentation.
  LabelImage read_image(const std::string &file, double scale);

  /// The file of the voxels that the header of a MetaImage or NRRD names; empty for any other file
  /// and where the voxels follow the header.
  /// @throws BadInput for a header that is missing or cannot be understood.
  std::string voxel_file(const std::string &file);
} // namespace softcell
