#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "detector/features/feature_settings.hpp"

namespace houghstream {

/// The features of the paper's Section 3. Bits of FeatureSettings::families.
enum FeatureFamily : std::uint32_t {
  kIntensity = 1,         ///< 16 planes: L, a, b, |Ix|, |Iy|, |Ixx|, |Iyy|, 9 HoG bins (Gall et al. 2011)
  kDepthValue = 2,        ///< 1 plane: the scaled depth (Lai et al. 2011)
  kDepthDerivatives = 4,  ///< 4 planes: first and second Sobel derivatives of the depth
  kDepthHog = 8,          ///< 9 planes: histogram of oriented depth gradients (Janoch et al. 2011)
  kHonv = 16,             ///< 12 planes: histogram of oriented normal vectors (Tang et al. 2013)
  kCurvature = 32,        ///< 5 planes: principal curvature (Arbeiter et al. 2012)
  kPointHistogram = 64,   ///< 125 planes: point feature histogram, PFH (Rusu et al. 2009)
  kFastHistogram = 128,   ///< 33 planes: fast point feature histogram, FPFH (Rusu et al. 2009)
};

/// The programs that search a scale space and compute surface families, for refusals.
constexpr const char* kStudyPrograms = "detector/baseline (hs-study train, hs-study evaluate, hs-study hough)";

/// Families that the product computes, and all families.
constexpr std::uint32_t kTileFamilies = kIntensity | kDepthValue | kDepthDerivatives | kDepthHog;
constexpr std::uint32_t kAllFamilies = kTileFamilies | kHonv | kCurvature | kPointHistogram | kFastHistogram;

/// Returns whether a family describes the surface around a point. These were studied in the paper, are not among its
/// final features, and are implemented in detector/baseline.
constexpr bool is_surface_family(FeatureFamily family) {
  return family >= kHonv;
}

/// Names for the command line and for reports, in the order of the planes.
struct FamilyName {
  FeatureFamily family;
  const char* name;
};
constexpr std::array<FamilyName, 8> kFamilyNames = {{{kIntensity, "intensity"},
                                                     {kDepthValue, "depth_value"},
                                                     {kDepthDerivatives, "depth_derivatives"},
                                                     {kDepthHog, "depth_hog"},
                                                     {kHonv, "honv"},
                                                     {kCurvature, "curvature"},
                                                     {kPointHistogram, "pfh"},
                                                     {kFastHistogram, "fpfh"}}};

/// Parses names such as "intensity,depth_hog" into bits. Throws InputError that lists the names for an unknown one, and
/// for none.
std::uint32_t parse_families(const std::string& names);

/// Bits -> "intensity,depth_hog".
std::string family_names(std::uint32_t families);

/// The planes of one family in a FeatureImage. Where `min_max`, the maxima of a 5x5 neighbourhood lie at first +
/// i and the minima at first + count + i (paper, Section 3, end).
struct FeatureBlock {
  FeatureFamily family = kIntensity;
  int first = 0;
  int count = 0;
  bool min_max = false;
  int planes() const { return min_max ? 2 * count : count; }
};

/// Kind of a plane, which decides about the tests on it.
enum class PlaneKind : std::uint8_t {
  kIntensity,     ///< lightness, colour and their changes: another light, other values
  kWrappedDepth,  ///< depth / kWrapStep modulo 256: only differences mean something, and they wrap too
  kScaledDepth,   ///< depth * object scale / kScaledStep: the same for an object at every distance (Section 3.2)
  kSurface,       ///< shape of the surface
  kHistogram,     ///< one of the many that together tell how the surface around a point is shaped
};

/// Layout of the planes in a FeatureImage.
class FeatureLayout {
 public:
  FeatureLayout() : FeatureLayout(FeatureSettings{}) {}
  explicit FeatureLayout(const FeatureSettings& settings);

  /// The two planes of a wrapped depth hold depth / kWrapStep modulo 256: a difference of two of them, taken modulo 256
  /// too, is exact for surfaces less than 0.5 m apart, at any distance.
  static constexpr float kWrapStep = 0.004F;    ///< metres
  static constexpr float kScaledStep = 0.010F;  ///< metres; 0 = no depth, 255 = 2.55 m and more

  int planes() const { return planes_; }
  /// Bytes from pixel to pixel: planes rounded up to half a cache line.
  int pixel_stride() const { return (planes_ + 31) / 32 * 32; }
  const std::vector<FeatureBlock>& blocks() const { return blocks_; }
  /// Returns the block of a family. Throws InputError where the layout lacks it.
  const FeatureBlock& block(FeatureFamily family) const;
  PlaneKind kind(int plane) const { return kinds_[static_cast<std::size_t>(plane)]; }

 private:
  std::vector<FeatureBlock> blocks_;
  std::vector<PlaneKind> kinds_;
  int planes_ = 0;
};

}  // namespace houghstream
