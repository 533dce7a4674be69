#include "tools/render/world/objects/materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

cv::Point point_in(const cv::Rect& region, double x, double y) {
  return {region.x + static_cast<int>(x * region.width), region.y + static_cast<int>(y * region.height)};
}

// Returns a region given in fractions of the image.
cv::Rect part_of(const cv::Size& size, double x, double y, double width, double height) {
  return {static_cast<int>(x * size.width), static_cast<int>(y * size.height), static_cast<int>(width * size.width),
          static_cast<int>(height * size.height)};
}

// Draws a band with a wavy upper edge that closes on itself round a can.
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
  // The title is drawn twice, as on most cans, so that one of them is visible from most sides.
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

cv::Mat screen_image(const cv::Size& size, Random& random) {
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

namespace {

// Returns white noise in [-1,1], CV_32FC1.
cv::Mat white_noise(const cv::Size& size, Random& random) {
  cv::Mat noise(size, CV_32FC1);
  const std::uint64_t seed = random.bits();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      noise.at<float>(y, x) = 2.0F * pixel_uniform(seed, static_cast<std::uint64_t>(y) * 65536U + x) - 1.0F;
    }
  }
  return noise;
}

// Returns colour * (1 + gain * noise), per pixel.
cv::Mat tint(const cv::Mat& noise, const cv::Scalar& colour, double gain) {
  cv::Mat factor;
  noise.convertTo(factor, CV_32F, gain, 1.0);
  std::vector<cv::Mat> channels(3);
  for (int c = 0; c < 3; ++c) factor.convertTo(channels[static_cast<std::size_t>(c)], CV_8U, colour[c]);
  cv::Mat image;
  cv::merge(channels, image);
  return image;
}

}  // namespace

cv::Mat smooth_noise(const cv::Size& size, double cells, int octaves, Random& random) {
  cv::Mat sum = cv::Mat::zeros(size, CV_32FC1);
  double weight = 0.6;
  for (int octave = 0; octave < octaves; ++octave) {
    const int width = std::clamp(static_cast<int>(std::lround(cells)), 2, size.width);
    const int height = std::clamp(static_cast<int>(std::lround(cells * size.height / size.width)), 2, size.height);
    cv::Mat layer;
    cv::resize(white_noise({width, height}, random), layer, size, 0, 0, cv::INTER_CUBIC);
    sum += weight * layer;
    weight *= 0.55;
    cells *= 2.0;
  }
  return sum;
}

cv::Mat plain(const cv::Size& size, const cv::Scalar& colour, double strength, Random& random) {
  const cv::Mat noise = smooth_noise(size, 3.0, 4, random) + 0.3 * white_noise(size, random);
  return tint(noise, colour, strength);
}

cv::Mat wood(const cv::Size& size, Random& random) {
  const cv::Scalar colour = hsv(random.uniform(14, 38), random.uniform(0.25, 0.7), random.uniform(0.3, 0.88));
  const cv::Mat warp = smooth_noise(size, 2.5, 3, random);
  const cv::Mat fibre = smooth_noise({std::max(2, size.width / 24), size.height}, 10.0, 4, random);
  cv::Mat fibres;
  cv::resize(fibre, fibres, size, 0, 0, cv::INTER_LINEAR);
  const double rings = random.uniform(6, 22);
  const double contrast = random.uniform(0.05, 0.2);
  cv::Mat grain(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double phase = rings * (static_cast<double>(y) / size.height + 0.16 * warp.at<float>(y, x));
      const double ring = phase - std::floor(phase);
      grain.at<float>(y, x) = static_cast<float>(ring * ring - 0.4 + 0.8 * fibres.at<float>(y, x));
    }
  }
  cv::Mat image = tint(grain, colour, contrast);
  const int planks = chance(random, 0.4) ? random.between(3, 8) : 0;
  for (int i = 1; i < planks; ++i) {
    const int y = i * size.height / planks;
    cv::line(image, {0, y}, {size.width, y}, colour * 0.5, 1 + size.height / 500);
  }
  return image;
}

cv::Mat fabric(const cv::Size& size, const cv::Scalar& colour, Random& random) {
  cv::Mat noise = 0.6 * smooth_noise(size, 4.0, 4, random) + 0.5 * white_noise(size, random);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) noise.at<float>(y, x) += ((x / 2 + y / 2) % 2 == 0) ? 0.25F : -0.25F;
  }
  cv::Mat image = tint(noise, colour, 0.14);
  if (chance(random, 0.5)) {
    const cv::Scalar stripe = random_palette(random).accent;
    const int step = random.between(size.width / 24, size.width / 8);
    const int width = std::max(2, step / random.between(3, 8));
    const bool check = chance(random, 0.5);
    cv::Mat overlay = image.clone();
    for (int x = step / 2; x < size.width; x += step) {
      cv::line(overlay, {x, 0}, {x, size.height}, stripe, width);
      if (check) cv::line(overlay, {0, x}, {size.width, x}, stripe, width);
    }
    cv::addWeighted(overlay, 0.6, image, 0.4, 0.0, image);
  }
  return image;
}

cv::Mat tiles(const cv::Size& size, Random& random) {
  const cv::Scalar colour = hsv(random.uniform(0, 360), random.uniform(0.0, 0.25), random.uniform(0.45, 0.95));
  cv::Mat image = plain(size, colour, 0.06, random);
  const int count = random.between(6, 16);
  const double step = static_cast<double>(size.width) / count;
  const double aspect = chance(random, 0.5) ? 1.0 : 0.5;
  const cv::Scalar grout = colour * random.uniform(0.55, 0.85);
  for (int row = 0; row * step * aspect < size.height; ++row) {
    const double shift = (aspect < 1.0 && row % 2 == 1) ? 0.5 : 0.0;
    for (int column = -1; column < count; ++column) {
      const cv::Rect tile(static_cast<int>((column + shift) * step), static_cast<int>(row * step * aspect),
                          static_cast<int>(step), static_cast<int>(step * aspect));
      const cv::Rect inside = tile & cv::Rect(0, 0, size.width, size.height);
      if (inside.area() > 0) image(inside) *= random.uniform(0.93, 1.05);
      cv::rectangle(image, tile, grout, std::max(1, size.width / 400));
    }
  }
  return image;
}

cv::Mat stone(const cv::Size& size, Random& random) {
  const cv::Scalar colour = hsv(random.uniform(0, 360), random.uniform(0.0, 0.15), random.uniform(0.2, 0.9));
  const cv::Mat noise = smooth_noise(size, 5.0, 5, random) + smooth_noise(size, size.width / 4.0, 2, random);
  return tint(noise, colour, random.uniform(0.1, 0.35));
}

cv::Mat carpet(const cv::Size& size, Random& random) {
  const cv::Scalar colour = hsv(random.uniform(0, 360), random.uniform(0.0, 0.4), random.uniform(0.15, 0.6));
  const cv::Mat noise = 0.7 * white_noise(size, random) + smooth_noise(size, 6.0, 5, random);
  return tint(noise, colour, 0.22);
}

cv::Mat wallpaper(const cv::Size& size, Random& random) {
  const cv::Scalar colour = hsv(random.uniform(0, 360), random.uniform(0.0, 0.3), random.uniform(0.5, 0.95));
  cv::Mat image = plain(size, colour, 0.04, random);
  const int kind = random.between(0, 3);  // 2, 3: painted plaster without a pattern
  const int step = random.between(size.width / 40, size.width / 14);
  const cv::Scalar ink = colour * random.uniform(0.75, 0.93);
  for (int x = 0; kind == 0 && x < size.width; x += step) {
    cv::line(image, {x, 0}, {x, size.height}, ink, std::max(1, step / 3));
  }
  for (int y = 0; kind == 1 && y < size.height; y += step) {
    for (int x = 0; x < size.width; x += step) {
      cv::circle(image, {x + (y / step % 2) * step / 2, y}, std::max(2, step / 5), ink, cv::FILLED, cv::LINE_AA);
    }
  }
  return image;
}

cv::Mat metal(const cv::Size& size, Random& random) {
  const double value = random.uniform(0.5, 0.8);
  cv::Mat streaks;
  cv::resize(white_noise({std::max(2, size.width / 32), size.height}, random), streaks, size, 0, 0, cv::INTER_LINEAR);
  return tint(streaks + smooth_noise(size, 3.0, 3, random), hsv(220, 0.04, value), 0.08);
}

}  // namespace houghstream::world
