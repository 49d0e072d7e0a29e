#include "vantage/formats/colmap_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "vantage/files/text_reader.hpp"
#include "vantage/formats/camera_parts.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {
namespace {

/// Where the parameters of a model stand: focal lengths, principal point and coefficients.
struct Model {
  std::string_view name;
  std::size_t focal_lengths;         // 1 or 2
  std::size_t coefficients;          // after the principal point
  std::array<std::size_t, 8> place;  // of each in Intrinsics::distortion
  LensModel lens = LensModel::polynomial;

  [[nodiscard]] std::size_t parameters() const { return focal_lengths + 2 + coefficients; }
};

constexpr std::array models{Model{"SIMPLE_PINHOLE", 1, 0, {}},
                            Model{"PINHOLE", 2, 0, {}},
                            Model{"SIMPLE_RADIAL", 1, 1, {0}},
                            Model{"RADIAL", 1, 2, {0, 1}},
                            Model{"OPENCV", 2, 4, {0, 1, 2, 3}},
                            Model{"FULL_OPENCV", 2, 8, {0, 1, 2, 3, 4, 5, 6, 7}},
                            Model{"OPENCV_FISHEYE", 2, 4, {0, 1, 2, 3}, LensModel::equidistant},
                            Model{"SIMPLE_RADIAL_FISHEYE", 1, 1, {0}, LensModel::equidistant},
                            Model{"RADIAL_FISHEYE", 1, 2, {0, 1}, LensModel::equidistant}};

const Model* model_named(std::string_view name) {
  const auto* const found = std::find_if(models.begin(), models.end(), [&](const Model& m) { return m.name == name; });
  return found == models.end() ? nullptr : found;
}

/// The next line with words that is no comment.
bool next_entry(TextReader& text) {
  while (text.next_line_with_words()) {
    if (trimmed(text.rest_of_line())[0] != '#') return true;
  }
  return false;
}

Intrinsics intrinsics_of_model(const Model& model, const std::vector<double>& p, const std::string& name) {
  const std::size_t center = model.focal_lengths;
  Intrinsics intrinsics{.fx = p[0],
                        .fy = p[model.focal_lengths - 1],
                        .cx = p[center] - 0.5,
                        .cy = p[center + 1] - 0.5,
                        .resolution = std::nullopt,
                        .distortion = {}};
  std::vector<double> coefficients(model.coefficients, 0.0);
  for (std::size_t i = 0; i < model.coefficients; ++i) coefficients[model.place[i]] = p[center + 2 + i];
  camera_parts::set_distortion(intrinsics, model.lens == LensModel::equidistant ? "equidistant" : "polynomial",
                               std::move(coefficients), name);
  return intrinsics;
}

}  // namespace

bool is_colmap_cameras(std::string_view bytes) {
  TextReader text(bytes, "");
  if (!next_entry(text) || !to_integer(text.word())) return false;
  const std::string_view model = text.word();
  return !model.empty() && model[0] >= 'A' && model[0] <= 'Z';
}

std::vector<ColmapCamera> parse_colmap_cameras(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  std::vector<ColmapCamera> cameras;
  while (next_entry(text)) {
    ColmapCamera camera;
    camera.id = text.integer("CAMERA_ID");
    const std::string_view model_name = text.word();
    const Model* model = model_named(model_name);
    if (model == nullptr)
      text.fail(fmt::format("camera model {} is not known; undistort the images to PINHOLE", in_quotes(model_name)));
    const double width = text.finite_number("WIDTH"), height = text.finite_number("HEIGHT");
    std::vector<double> parameters;
    for (std::size_t i = 0; i < model->parameters(); ++i) parameters.push_back(text.finite_number("a parameter"));
    camera.intrinsics = intrinsics_of_model(*model, parameters, name);
    camera.intrinsics.resolution = camera_parts::resolution_of(width, height, name);
    camera.intrinsics =
        camera_parts::checked(std::move(camera.intrinsics), fmt::format("{}: camera {}", name, camera.id));
    cameras.push_back(std::move(camera));
  }
  require(!cameras.empty(), name, ": has no camera; must have lines CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS");
  return cameras;
}

std::vector<ColmapImage> parse_colmap_images(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  std::vector<ColmapImage> images;
  while (next_entry(text)) {
    ColmapImage image;
    (void)text.integer("IMAGE_ID");
    std::array<double, 7> n{};
    constexpr std::array<const char*, 7> columns{"QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = text.finite_number(columns[i]);
    image.camera = text.integer("CAMERA_ID");
    image.name = trimmed(text.rest_of_line());
    if (image.name.empty()) text.fail("NAME is missing");
    image.world_from_sensor =
        pose_from_quaternion({n[4], n[5], n[6]}, {n[0], n[1], n[2], n[3]}, fmt::format("{}: {}", name, image.name))
            .inverse();
    images.push_back(std::move(image));
    (void)text.next_line();  // the points of the image, which may be none
  }
  require(!images.empty(), name, ": has no image; must have lines IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
  return images;
}

}  // namespace vantage
