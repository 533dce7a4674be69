#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "pipeline/base/random.hpp"

// These draw textures like those printed on boxes, cans, mugs and covers. All are CV_8UC3 BGR, drawn from the given
// generator only.

namespace houghstream::world {

/// Holds the colours of one texture.
struct Palette {
  cv::Scalar base;    ///< most of the surface
  cv::Scalar accent;  ///< panels, stripes
  cv::Scalar light;   ///< lettering on dark ground
  cv::Scalar dark;    ///< lettering on light ground
};
Palette random_palette(Random& random);

/// Returns BGR of a hue 0-360 degrees, saturation and value 0-1.
cv::Scalar hsv(double hue_deg, double saturation, double value);

/// Returns a made-up brand word of capital and small letters.
std::string brand_word(Random& random);

// These draw elements inside a region of an image.
void draw_title(cv::Mat& image, const cv::Rect& region, const cv::Scalar& colour, Random& random);
void draw_text_lines(cv::Mat& image, const cv::Rect& region, const cv::Scalar& colour, Random& random);
void draw_barcode(cv::Mat& image, const cv::Rect& region, Random& random);
void draw_logo(cv::Mat& image, const cv::Rect& region, const Palette& palette, Random& random);
void draw_photo(cv::Mat& image, const cv::Rect& region, Random& random);  ///< noise blobs like a product photograph

// These draw whole surfaces.
cv::Mat carton_front(const cv::Size& size, const Palette& palette, Random& random);
cv::Mat carton_side(const cv::Size& size, const Palette& palette, Random& random);
cv::Mat can_label(const cv::Size& size, const Palette& palette, Random& random);  ///< wraps round, u = 0 meets u = 1
cv::Mat mug_print(const cv::Size& size, const Palette& palette, Random& random);  ///< glaze with a motif
cv::Mat book_cover(const cv::Size& size, const Palette& palette, Random& random);
cv::Mat screen_image(const cv::Size& size, Random& random);  ///< windows on a monitor
cv::Mat keyboard_top(const cv::Size& size, Random& random);
cv::Mat poster(const cv::Size& size, Random& random);

}  // namespace houghstream::world

// These are textures without print. All are CV_8UC3 BGR, drawn from the given generator only.

namespace houghstream::world {

/// Returns smooth noise of several octaves, CV_32FC1, mean about 0, range about -1 to 1. `cells` is the number of grid
/// cells across the width in the coarsest octave.
cv::Mat smooth_noise(const cv::Size& size, double cells, int octaves, Random& random);

/// Draws one colour with faint unevenness (`strength` 0-1): paint, plastic, glaze, plaster.
cv::Mat plain(const cv::Size& size, const cv::Scalar& colour, double strength, Random& random);

cv::Mat wood(const cv::Size& size, Random& random);
cv::Mat fabric(const cv::Size& size, const cv::Scalar& colour, Random& random);  ///< woven, sometimes striped
cv::Mat tiles(const cv::Size& size, Random& random);
cv::Mat stone(const cv::Size& size, Random& random);   ///< speckled worktop
cv::Mat carpet(const cv::Size& size, Random& random);  ///< floor textile
cv::Mat wallpaper(const cv::Size& size, Random& random);

/// Draws brushed or cast metal.
cv::Mat metal(const cv::Size& size, Random& random);

}  // namespace houghstream::world
