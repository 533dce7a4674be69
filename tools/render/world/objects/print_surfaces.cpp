#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/prints.hpp"
#include "tools/render/world/optics/pixel_noise.hpp"

namespace houghstream {
namespace {

// A region given in fractions of the image.
cv::Rect part_of(const cv::Size& size, double x, double y, double width, double height) {
  return {static_cast<int>(x * size.width), static_cast<int>(y * size.height), static_cast<int>(width * size.width),
          static_cast<int>(height * size.height)};
}

// Band with a wavy upper edge that closes on itself round a can.
void draw_wave(cv::Mat& image, double level, double height, const cv::Scalar& colour, Random& random) {
  const int waves = random.between(1, 4);
  const double phase = random.uniform(0, 2 * M_PI);
  const double swing = random.uniform(0.02, 0.1) * image.rows;
  for (int x = 0; x < image.cols; ++x) {
    const double offset = swing * std::sin(phase + 2.0 * M_PI * waves * x / image.cols);
    const int top = static_cast<int>(level * image.rows + offset);
    cv::line(image, {x, top}, {x, top + static_cast<int>(height * image.rows)}, colour, 1);
  }
}

}  // namespace

cv::Mat carton_front(const cv::Size& size, const Palette& palette, Random& random) {
  cv::Mat image = plain(size, palette.base, 0.08, random);
  const double title_top = random.uniform(0.04, 0.14);
  const double photo_top = random.uniform(0.46, 0.56);
  if (chance(random, 0.6)) {
    const std::vector<cv::Point> sweep = {{0, static_cast<int>(photo_top * size.height)},
                                          {size.width, static_cast<int>(random.uniform(0.3, 0.5) * size.height)},
                                          {size.width, size.height},
                                          {0, size.height}};
    cv::fillPoly(image, std::vector<std::vector<cv::Point>>{sweep}, palette.accent, cv::LINE_AA);
  }
  draw_photo(image, part_of(size, random.uniform(0.05, 0.2), photo_top, random.uniform(0.55, 0.75), 0.36), random);
  draw_title(image, part_of(size, 0.05, title_top, 0.9, 0.2), palette.light, random);
  draw_title(image, part_of(size, 0.15, title_top + 0.2, 0.7, 0.09), palette.dark, random);
  draw_logo(image, part_of(size, random.uniform(0.55, 0.7), 0.36, 0.26, 0.18), palette, random);
  draw_text_lines(image, part_of(size, 0.06, 0.93, 0.6, 0.05), palette.light, random);
  return image;
}

cv::Mat carton_side(const cv::Size& size, const Palette& palette, Random& random) {
  cv::Mat image = plain(size, palette.base, 0.06, random);
  const cv::Rect table = part_of(size, 0.1, 0.3, 0.8, 0.42);
  cv::rectangle(image, table, {240, 242, 244}, cv::FILLED);
  cv::rectangle(image, table, {20, 20, 20}, 2);
  draw_text_lines(image, part_of(size, 0.14, 0.32, 0.72, 0.38), {30, 30, 30}, random);
  draw_title(image, part_of(size, 0.08, 0.04, 0.84, 0.12), palette.light, random);
  draw_text_lines(image, part_of(size, 0.1, 0.17, 0.8, 0.11), palette.dark, random);
  draw_barcode(image, part_of(size, 0.15, 0.77, 0.7, 0.16), random);
  return image;
}

cv::Mat can_label(const cv::Size& size, const Palette& palette, Random& random) {
  cv::Mat image = plain(size, palette.base, 0.05, random);
  draw_wave(image, random.uniform(0.55, 0.8), 0.5, palette.accent, random);
  draw_wave(image, random.uniform(0.5, 0.8), random.uniform(0.02, 0.08), palette.light, random);
  // The title stands twice, as on most cans, so that one of them is seen from most sides.
  for (const double x : {0.03, 0.53}) {
    draw_logo(image, part_of(size, x + 0.11, random.uniform(0.08, 0.16), 0.18, 0.3), palette, random);
    draw_title(image, part_of(size, x, 0.36, 0.4, 0.28), palette.light, random);
    draw_text_lines(image, part_of(size, x + 0.08, 0.82, 0.25, 0.1), palette.light, random);
  }
  draw_barcode(image, part_of(size, 0.44, 0.55, 0.08, 0.35), random);
  draw_text_lines(image, part_of(size, 0.93, 0.2, 0.06, 0.6), palette.light, random);
  return image;
}

cv::Mat mug_print(const cv::Size& size, const Palette& palette, Random& random) {
  cv::Mat image = plain(size, palette.base, 0.03, random);
  const int bands = random.between(1, 3);
  for (int i = 0; i < bands; ++i) {
    const int y = static_cast<int>(size.height * random.uniform(0.05, 0.95));
    cv::line(image, {0, y}, {size.width, y}, palette.accent, random.between(size.height / 40, size.height / 12));
  }
  for (const double x : {0.1, 0.6}) {
    draw_logo(image, part_of(size, x, 0.15, 0.24, 0.5), palette, random);
    draw_title(image, part_of(size, x - 0.04, 0.66, 0.32, 0.2), palette.dark, random);
  }
  return image;
}

cv::Mat book_cover(const cv::Size& size, const Palette& palette, Random& random) {
  cv::Mat image = plain(size, palette.base, 0.05, random);
  draw_title(image, part_of(size, 0.08, random.uniform(0.05, 0.2), 0.84, 0.2), palette.light, random);
  if (chance(random, 0.7)) draw_photo(image, part_of(size, 0.12, 0.45, 0.76, random.uniform(0.3, 0.45)), random);
  draw_text_lines(image, part_of(size, 0.2, 0.3, 0.6, 0.1), palette.light, random);
  return image;
}

cv::Mat screen_picture(const cv::Size& size, Random& random) {
  cv::Mat image = plain(size, hsv(random.uniform(0, 360), 0.4, 0.5), 0.4, random);
  const int windows = random.between(1, 4);
  for (int i = 0; i < windows; ++i) {
    const cv::Rect window = part_of(size, random.uniform(0.0, 0.5), random.uniform(0.0, 0.4), random.uniform(0.3, 0.5),
                                    random.uniform(0.3, 0.6));
    const cv::Scalar paper = chance(random, 0.7) ? cv::Scalar(240, 240, 240) : cv::Scalar(45, 40, 38);
    cv::rectangle(image, window, paper, cv::FILLED);
    cv::rectangle(image, {window.x, window.y, window.width, std::max(6, window.height / 14)},
                  hsv(random.uniform(0, 360), 0.5, 0.6), cv::FILLED);
    draw_text_lines(image, {window.x + 8, window.y + window.height / 8, window.width - 16, window.height * 3 / 4},
                    cv::Scalar(140, 140, 140), random);
  }
  cv::rectangle(image, {0, 0, size.width, size.height}, {20, 20, 20}, std::max(6, size.width / 50));
  return image;
}

cv::Mat keyboard_top(const cv::Size& size, Random& random) {
  const double value = chance(random, 0.6) ? random.uniform(0.08, 0.2) : random.uniform(0.7, 0.9);
  cv::Mat image = plain(size, hsv(220, 0.05, value), 0.05, random);
  const int key = size.height / 6;
  const cv::Scalar cap = hsv(220, 0.05, value > 0.5 ? value * 0.85 : value * 1.6);
  for (int row = 0; row < 5; ++row) {
    for (int x = key / 3; x + key < size.width; x += key) {
      const cv::Rect place(x + (row % 2) * key / 3, key / 2 + row * key, key - 4, key - 4);
      cv::rectangle(image, place, cap, cv::FILLED);
      cv::circle(image, {place.x + key / 3, place.y + key / 3}, std::max(1, key / 10),
                 value > 0.5 ? cv::Scalar(40, 40, 40) : cv::Scalar(220, 220, 220), cv::FILLED, cv::LINE_AA);
    }
  }
  return image;
}

cv::Mat poster(const cv::Size& size, Random& random) {
  const Palette palette = random_palette(random);
  cv::Mat image = plain(size, palette.light, 0.05, random);
  draw_photo(image, part_of(size, 0.06, 0.06, 0.88, random.uniform(0.5, 0.7)), random);
  draw_title(image, part_of(size, 0.1, 0.76, 0.8, 0.1), palette.dark, random);
  draw_text_lines(image, part_of(size, 0.1, 0.87, 0.8, 0.09), palette.dark, random);
  return image;
}

}  // namespace houghstream
