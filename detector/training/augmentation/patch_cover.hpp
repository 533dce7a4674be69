#pragma once

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/features/patch_settings.hpp"
#include "detector/training/augmentation/cutout.hpp"
#include "detector/training/augmentation/training_sample.hpp"

namespace houghstream::training {

/// Returns parts of an image that hold every one of these rectangles whole, each in one part: patches that overlap
/// share pixels, and next to nothing is held of the room between those that stand apart. Deterministic.
std::vector<RowSpans> cover_patches(const std::vector<cv::Rect>& seen);

/// Cuts what patches read out of an image, and writes into each sample the index of its cutout, from `first` on.
std::vector<Cutout> cut_out_patches(const FeatureImage& image, const PatchSettings& patch, std::int32_t first,
                                    const std::vector<TrainingSample*>& readers);
std::vector<Cutout> cut_out_patches(const Cutout& image, const PatchSettings& patch, std::int32_t first,
                                    const std::vector<TrainingSample*>& readers);

}  // namespace houghstream::training
