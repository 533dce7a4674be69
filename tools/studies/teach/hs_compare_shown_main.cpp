#include <fmt/format.h>

#include "drivers/files/image_file.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/fuse/model_picture.hpp"
#include "tools/studies/teach/shown_comparison.hpp"

namespace {

using namespace houghstream;

struct CompareOptions {
  std::string takes;
  std::filesystem::path kept;
  std::string object;
  std::filesystem::path out;
};

void run(const CompareOptions& options) {
  const studies::TrueTakes takes = studies::read_true_takes(options.takes, options.object);
  const Mesh taught = load_mesh(options.kept / "model.ply");
  const studies::ShownComparison comparison = studies::compare_shown(takes, options.kept, taught);
  std::filesystem::create_directories(options.out);
  write_json(to_json(comparison), options.out / "compared.json");
  Mesh placed = taught;  // as the true mesh stands
  for (Eigen::Vector3f& vertex : placed.vertices) vertex = comparison.T_true_taught.cast<float>() * vertex;
  for (Eigen::Vector3f& normal : placed.normals) normal = comparison.T_true_taught.linear().cast<float>() * normal;
  write_png(draw_model(placed), options.out / "taught.png");
  write_png(draw_model(takes.mesh), options.out / "true.png");
  fmt::print("{}: {:.2f} mm from the true surface (95 %: {:.2f}), masks {:.3f}, {} views\n", options.object,
             1e3 * comparison.taught_to_true.median, 1e3 * comparison.taught_to_true.most, comparison.mask_iou,
             comparison.views);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Compares what hs-teach show made of rendered takes with the truth", "hs-compare-shown");
  CompareOptions options;
  app.add_option("--takes", options.takes, "folder of hs-render takes").required();
  app.add_option("--object", options.object, "its name there").required();
  app.add_option("--kept", options.kept, "folder of hs-teach show --keep").required();
  app.add_option("--out", options.out, "folder for compared.json, taught.png and true.png").required();
  return run_tool(app, argc, argv, [&] { run(options); });
}
