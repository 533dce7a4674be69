#include <opencv2/imgproc.hpp>

#include "detector/features/features.hpp"

namespace houghstream {

namespace {

cv::Mat absolute_derivative(const cv::Mat& lightness, int dx, int dy, double gain) {
  cv::Mat derivative;
  cv::Sobel(lightness, derivative, CV_16S, dx, dy, 3, 1.0, 0.0, cv::BORDER_REPLICATE);
  cv::Mat out;
  cv::convertScaleAbs(derivative, out, gain);
  return out;
}

}  // namespace

std::vector<cv::Mat> intensity_planes(const cv::Mat& colour_bgr) {
  cv::Mat lab;
  cv::cvtColor(colour_bgr, lab, cv::COLOR_BGR2Lab);
  std::vector<cv::Mat> planes;
  cv::split(lab, planes);
  const cv::Mat lightness = planes[0];
  planes.push_back(absolute_derivative(lightness, 1, 0, 0.5));
  planes.push_back(absolute_derivative(lightness, 0, 1, 0.5));
  planes.push_back(absolute_derivative(lightness, 2, 0, 0.5));
  planes.push_back(absolute_derivative(lightness, 0, 2, 0.5));
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(lightness, dx, CV_32F, 1, 0, 3, 0.125, 0.0, cv::BORDER_REPLICATE);
  cv::Sobel(lightness, dy, CV_32F, 0, 1, 3, 0.125, 0.0, cv::BORDER_REPLICATE);
  for (cv::Mat& plane : gradient_histograms(dx, dy, kIntensityGain)) planes.push_back(std::move(plane));
  return planes;
}

}  // namespace houghstream
