#include "tools/render/world/objects/materials.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/prints.hpp"

namespace houghstream::world {
namespace {

// White noise in [-1,1], CV_32FC1.
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

// colour * (1 + gain * noise), per pixel.
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
