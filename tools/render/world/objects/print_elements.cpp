#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/prints.hpp"
#include "tools/render/world/optics/pixel_noise.hpp"

namespace houghstream {
namespace {

cv::Point point_in(const cv::Rect& region, double x, double y) {
  return {region.x + static_cast<int>(x * region.width), region.y + static_cast<int>(y * region.height)};
}

}  // namespace

cv::Scalar hsv(double hue_deg, double saturation, double value) {
  const double sector = std::fmod(std::fmod(hue_deg, 360.0) + 360.0, 360.0) / 60.0;
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + sector, 6.0);
    return 255.0 * value * (1.0 - saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0));
  };
  return {channel(1.0), channel(3.0), channel(5.0)};
}

Palette random_palette(Random& random) {
  const double hue = random.uniform(0, 360);
  const double apart = chance(random, 0.5) ? random.uniform(20, 60) : random.uniform(140, 220);
  Palette palette;
  palette.base = hsv(hue, random.uniform(0.35, 0.9), random.uniform(0.35, 0.9));
  if (chance(random, 0.3)) palette.base = hsv(hue, random.uniform(0.0, 0.15), random.uniform(0.75, 0.95));
  palette.accent = hsv(hue + apart, random.uniform(0.5, 0.95), random.uniform(0.4, 0.95));
  palette.light = hsv(hue + apart, random.uniform(0.0, 0.15), random.uniform(0.88, 1.0));
  palette.dark = hsv(hue, random.uniform(0.2, 0.8), random.uniform(0.08, 0.25));
  return palette;
}

std::string brand_word(Random& random) {
  const std::string consonants = "BCDFGKLMNPRSTVZ";
  const std::string vowels = "aeiou";
  std::string word;
  const int syllables = random.between(2, 3);
  for (int i = 0; i < syllables; ++i) {
    const char consonant = pick(random, consonants);
    word += i == 0 ? consonant : static_cast<char>(consonant + ('a' - 'A'));
    word += pick(random, vowels);
  }
  return chance(random, 0.5) ? word + pick(random, std::string("xnsrlt")) : word;
}

void draw_title(cv::Mat& image, const cv::Rect& region, const cv::Scalar& colour, Random& random) {
  const std::array<int, 4> fonts = {cv::FONT_HERSHEY_DUPLEX, cv::FONT_HERSHEY_TRIPLEX, cv::FONT_HERSHEY_SIMPLEX,
                                    cv::FONT_HERSHEY_SCRIPT_COMPLEX};
  const int font = pick(random, fonts);
  const std::string word = brand_word(random);
  int baseline = 0;
  const cv::Size unit = cv::getTextSize(word, font, 1.0, 2, &baseline);
  const double scale = std::min(0.92 * region.width / unit.width, 0.8 * region.height / unit.height);
  const int thickness = std::max(1, static_cast<int>(scale * random.uniform(2.0, 5.0)));
  const cv::Size extent(static_cast<int>(unit.width * scale), static_cast<int>(unit.height * scale));
  const cv::Point origin(region.x + (region.width - extent.width) / 2, region.y + (region.height + extent.height) / 2);
  cv::putText(image, word, origin + cv::Point(thickness, thickness), font, scale, colour * 0.25, thickness + 2,
              cv::LINE_AA);
  cv::putText(image, word, origin, font, scale, colour, thickness, cv::LINE_AA);
}

void draw_text_lines(cv::Mat& image, const cv::Rect& region, const cv::Scalar& colour, Random& random) {
  const int line_height = std::max(5, random.between(region.height / 16, region.height / 8));
  for (int y = region.y; y + line_height <= region.y + region.height; y += line_height) {
    const int end = region.x + static_cast<int>(region.width * random.uniform(0.55, 1.0));
    int x = region.x;
    while (x < end) {
      const int word = std::min(random.between(line_height, 5 * line_height), end - x);
      for (int i = 0; i < word; i += std::max(2, line_height / 3)) {
        const int top = y + (chance(random, 0.3) ? 0 : line_height / 5);
        cv::rectangle(image, {x + i, top}, {x + i + std::max(0, line_height / 6), y + line_height * 3 / 5}, colour,
                      cv::FILLED);
      }
      x += word + line_height / 2;
    }
  }
}

void draw_barcode(cv::Mat& image, const cv::Rect& region, Random& random) {
  cv::rectangle(image, region, {245, 245, 245}, cv::FILLED);
  int x = region.x + region.width / 12;
  while (x < region.x + region.width * 11 / 12) {
    const int width = random.between(1, std::max(1, region.width / 28));
    if (chance(random, 0.5)) {
      cv::rectangle(image, {x, region.y + region.height / 10}, {x + width - 1, region.y + region.height * 8 / 10},
                    {20, 20, 20}, cv::FILLED);
    }
    x += width;
  }
}

void draw_logo(cv::Mat& image, const cv::Rect& region, const Palette& palette, Random& random) {
  const cv::Point centre = point_in(region, 0.5, 0.5);
  const int radius = std::min(region.width, region.height) / 2;
  const int kind = random.between(0, 2);
  if (kind == 0) {  // star
    std::vector<cv::Point> star;
    const int points = random.between(5, 14);
    const double inner = random.uniform(0.45, 0.8);
    star.reserve(2 * static_cast<std::size_t>(points));
    for (int i = 0; i < 2 * points; ++i) {
      const double r = radius * (i % 2 == 0 ? 1.0 : inner);
      const double angle = M_PI * i / points;
      star.emplace_back(centre.x + static_cast<int>(r * std::sin(angle)),
                        centre.y - static_cast<int>(r * std::cos(angle)));
    }
    cv::fillPoly(image, std::vector<std::vector<cv::Point>>{star}, palette.accent, cv::LINE_AA);
  } else if (kind == 1) {  // roundel
    cv::circle(image, centre, radius, palette.light, cv::FILLED, cv::LINE_AA);
    cv::circle(image, centre, radius * 4 / 5, palette.accent, cv::FILLED, cv::LINE_AA);
    cv::circle(image, centre, radius * 2 / 5, palette.dark, cv::FILLED, cv::LINE_AA);
  } else {  // leaf or eye
    cv::ellipse(image, centre, {radius, radius / 2}, random.uniform(0, 180), 0, 360, palette.accent, cv::FILLED,
                cv::LINE_AA);
    cv::ellipse(image, centre, {radius / 2, radius / 3}, random.uniform(0, 180), 0, 360, palette.light, cv::FILLED,
                cv::LINE_AA);
  }
  const int half = radius * 7 / 10;
  draw_title(image, {centre.x - half, centre.y - radius / 4, 2 * half, std::max(4, radius / 2)}, palette.light, random);
}

void draw_photo(cv::Mat& image, const cv::Rect& region, Random& random) {
  const cv::Rect inside = region & cv::Rect(0, 0, image.cols, image.rows);
  if (inside.width < 8 || inside.height < 8) return;
  cv::Mat target = image(inside);
  const cv::Scalar ground = hsv(random.uniform(0, 360), random.uniform(0.1, 0.7), random.uniform(0.3, 0.9));
  plain(inside.size(), ground, 0.35, random).copyTo(target);
  const int pieces = random.between(25, 70);
  const double hue = random.uniform(0, 60);
  for (int i = 0; i < pieces; ++i) {
    const cv::Point centre(random.between(0, inside.width), random.between(0, inside.height));
    const int radius = std::max(2, static_cast<int>(inside.width * random.uniform(0.02, 0.1)));
    const cv::Size axes(radius, std::max(1, static_cast<int>(radius * random.uniform(0.5, 1.0))));
    const cv::Scalar colour = hsv(hue + random.uniform(-25, 25), random.uniform(0.3, 0.9), random.uniform(0.35, 0.95));
    const double angle = random.uniform(0, 180);
    cv::ellipse(target, centre + cv::Point(radius / 4, radius / 4), axes, angle, 0, 360, colour * 0.45, cv::FILLED,
                cv::LINE_AA);
    cv::ellipse(target, centre, axes, angle, 0, 360, colour, cv::FILLED, cv::LINE_AA);
    cv::circle(target, centre - cv::Point(radius / 3, radius / 3), std::max(1, radius / 5), {240, 245, 250}, cv::FILLED,
               cv::LINE_AA);
  }
  cv::GaussianBlur(target, target, {3, 3}, 0);
}

}  // namespace houghstream
