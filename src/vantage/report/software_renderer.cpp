#include "vantage/report/software_renderer.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/report/badge.hpp"
#include "vantage/report/render_frame.hpp"

namespace vantage {
namespace {

constexpr int band_rows = 32;  // pixel rows that one task draws

Vec3f linear_light(const Color& color) {
  const auto channel = [](double value) {
    return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  };
  return {channel(color.red), channel(color.green), channel(color.blue)};
}

/// Linear light to the bytes of sRGB, by table: a power per channel would cost more than all the rest of a pixel.
class SrgbTable {
 public:
  SrgbTable() : bytes_(size + 1) {
    for (int i = 0; i <= size; ++i) {
      const double light = static_cast<double>(i) / size;
      const double channel = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      bytes_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(channel * 255));
    }
  }
  [[nodiscard]] std::uint8_t operator()(float light) const {
    return bytes_[static_cast<std::size_t>(std::clamp(light, 0.0F, 1.0F) * size + 0.5F)];
  }

 private:
  static constexpr int size = 1 << 15;
  std::vector<std::uint8_t> bytes_;
};

/// Shade that the solids cast on the plane at a height along `up`: 1 where all light arrives.
class Floor {
 public:
  Floor(const SkyLight& sky, const SkyLight::Lamps& lamps, const Vec3& eye, const Vec3& up, double height)
      : up_(up.normalized().cast<float>()), height_(static_cast<float>(height)), radius_(sky.radius()) {
    u_ = up_.unitOrthogonal();
    v_ = up_.cross(u_);
    middle_ = sky.center() + (height_ - sky.center().dot(up_)) * up_;
    if (eye.dot(up.normalized()) <= height) return;  // never seen
    const Vec3f full = sky.unobstructed(up_, lamps);
    share_.resize(side * side);
    parallel_for(side, [&](std::size_t row) {
      for (std::size_t column = 0; column < side; ++column) {
        const Vec3f point = middle_ + extent() * (coordinate(column) * u_ + coordinate(row) * v_);
        share_[row * side + column] = sky.arriving(point, up_, lamps).cwiseQuotient(full);
      }
    });
    for (int pass = 0; pass < 3; ++pass)  // the steps between the lamps' shadows melt
      for (const std::size_t step : {std::size_t{1}, side}) blur(step);
  }
  /// The shade where a ray from `eye` meets the floor.
  [[nodiscard]] Vec3f at(const Vec3f& eye, const Vec3f& ray) const {
    const float depth = (height_ - eye.dot(up_)) / ray.dot(up_);
    if (radius_ == 0 || share_.empty() || !(depth > 0)) return Vec3f::Ones();
    const Vec3f offset = (eye + depth * ray - middle_) / extent();
    const float away = offset.norm();
    if (away >= 1) return Vec3f::Ones();
    const float x = (offset.dot(u_) + 1) / 2 * (side - 1), y = (offset.dot(v_) + 1) / 2 * (side - 1);
    const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
    const float right = x - static_cast<float>(column), below = y - static_cast<float>(row);
    const Vec3f* texel = &share_[row * side + column];
    const Vec3f share = (1 - below) * ((1 - right) * texel[0] + right * texel[1]) +
                        below * ((1 - right) * texel[side] + right * texel[side + 1]);
    const float fade = std::clamp((1 - away) / 0.4F, 0.0F, 1.0F);  // ends in plain background
    return Vec3f::Ones() + fade * fade * (3 - 2 * fade) * (share - Vec3f::Ones());
  }

 private:
  static constexpr std::size_t side = 96;

  /// The mean of five texels along rows (step 1) or columns (step `side`); beyond the border all light arrives.
  void blur(std::size_t step) {
    constexpr std::size_t reach = 2;
    const std::size_t across = step == 1 ? side : 1;
    std::vector<Vec3f> line(side + 2 * reach);
    for (std::size_t k = 0; k < side; ++k) {
      std::fill(line.begin(), line.end(), Vec3f::Ones());
      for (std::size_t i = 0; i < side; ++i) line[i + reach] = share_[k * across + i * step];
      for (std::size_t i = 0; i < side; ++i) {
        Vec3f sum = Vec3f::Zero();
        for (std::size_t j = i; j <= i + 2 * reach; ++j) sum += line[j];
        share_[k * across + i * step] = sum / static_cast<float>(2 * reach + 1);
      }
    }
  }
  [[nodiscard]] float extent() const { return 2.2F * radius_; }
  [[nodiscard]] static float coordinate(std::size_t k) { return 2 * static_cast<float>(k) / (side - 1) - 1; }

  Vec3f up_, u_, v_, middle_;
  float height_, radius_;
  std::vector<Vec3f> share_;
};

/// Colours the samples of a frame.
class Shader {
 public:
  Shader(const PictureScene& scene, const SkyLight& sky, const Screen& screen, const Vec3& up, const Vec3f& background)
      : scene_(&scene),
        sky_(&sky),
        screen_(&screen),
        lamps_(sky.lamps(screen.world_from_camera(), up)),
        background_(background) {
    const auto remember = [](const auto& primitives) {
      std::vector<Vec3f> colors;
      colors.reserve(primitives.size());
      for (const auto& primitive : primitives) colors.push_back(linear_light(primitive.color));
      return colors;
    };
    facet_colors_ = remember(scene.facets);
    disc_colors_ = remember(scene.discs);
    stroke_colors_ = remember(scene.strokes);
    dot_colors_ = remember(scene.dots);
    const Box3 box = scene.box();
    const auto middle = static_cast<float>(box.isEmpty() ? 1 : screen.in_camera(Vec3(box.center())).z());
    const auto reach = static_cast<float>(box.isEmpty() ? 1 : box.diagonal().norm() / 2);
    nearest_ = middle - 0.6F * reach;
    farthest_ = middle + 0.6F * reach;
  }
  [[nodiscard]] const SkyLight::Lamps& lamps() const { return lamps_; }

  /// The light of the samples of one pixel that see the same smooth surface is computed once.
  struct PixelLight {
    struct Entry {
      Vec3f normal, light;
      float nearness = 0;
      bool marker = false;
    };
    std::array<Entry, 4> entries;
    std::size_t used = 0;
  };
  [[nodiscard]] Vec3f color(const RenderFrame::Hit& hit, float x, float y, PixelLight& known) const {
    if (hit.kind == RenderFrame::Kind::stroke) return hazy(stroke_colors_[hit.index], 1 / hit.nearness);
    if (hit.kind == RenderFrame::Kind::dot) return hazy(dot_colors_[hit.index], 1 / hit.nearness);
    const Vec3f ray = screen_->ray(x, y), point = screen_->eye() + ray / hit.nearness;
    if (hit.kind == RenderFrame::Kind::disc) {
      const PictureScene::Disc& disc = scene_->discs[hit.index];
      const Vec3f normal = disc.normal.isZero() ? Vec3f(-ray.normalized()) : disc.normal;
      return lit(disc_colors_[hit.index], {facing(normal, ray), {}, hit.nearness, false}, point, known);
    }
    const PictureScene::Facet& facet = scene_->facets[hit.index];
    const bool marker = facet.finish == PictureScene::Finish::marker;
    const Vec3f normal = facing(normal_at(facet, point), ray);
    const float edge = facet.finish == PictureScene::Finish::voxel ? edge_shade(point, normal) : 1.0F;
    return edge * lit(facet_colors_[hit.index], {normal, {}, hit.nearness, marker}, point, known);
  }

 private:
  /// Strokes and dots pale with their depth, so that front and back can be told apart.
  [[nodiscard]] Vec3f hazy(const Vec3f& color, float depth) const {
    const float share = 0.6F * std::clamp((depth - nearest_) / (farthest_ - nearest_), 0.0F, 1.0F);
    return color + share * (background_ - color);
  }

  static Vec3f facing(const Vec3f& normal, const Vec3f& ray) { return normal.dot(ray) > 0 ? Vec3f(-normal) : normal; }

  static Vec3f normal_at(const PictureScene::Facet& facet, const Vec3f& point) {
    const Vec3f a = facet.corner[1] - facet.corner[0], b = facet.corner[2] - facet.corner[0];
    const Vec3f across = a.cross(b), offset = point - facet.corner[0];
    const float area = across.squaredNorm();
    const float share1 = offset.cross(b).dot(across) / area, share2 = a.cross(offset).dot(across) / area;
    const Vec3f sum = (1 - share1 - share2) * facet.normal[0] + share1 * facet.normal[1] + share2 * facet.normal[2];
    const float length = sum.norm();
    return length > 0 ? Vec3f(sum / length) : Vec3f(across / std::sqrt(area));
  }

  /// Darkens a narrow rim of a voxel's face, so that cubes can be told apart.
  [[nodiscard]] float edge_shade(const Vec3f& point, const Vec3f& normal) const {
    constexpr float rim = 0.055F;  // of the edge
    const Vec3f place = (point - scene_->lattice.min.cast<float>()) / static_cast<float>(scene_->lattice.length);
    float nearest = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(normal[axis]) > 0.5F) continue;
      nearest = std::min(nearest, std::abs(place[axis] - std::round(place[axis])));
    }
    return nearest < rim ? 0.62F : 1.0F;
  }

  [[nodiscard]] Vec3f lit(const Vec3f& color, PixelLight::Entry entry, const Vec3f& point, PixelLight& known) const {
    for (std::size_t i = 0; i < known.used; ++i) {
      const PixelLight::Entry& other = known.entries[i];
      if (other.marker == entry.marker && other.normal.dot(entry.normal) > 0.98F &&
          std::abs(other.nearness - entry.nearness) < 0.01F * entry.nearness)
        return color.cwiseProduct(other.light);
    }
    entry.light = entry.marker ? sky_->unobstructed(entry.normal, lamps_) : sky_->arriving(point, entry.normal, lamps_);
    if (known.used < known.entries.size()) known.entries[known.used++] = entry;
    return color.cwiseProduct(entry.light);
  }

  const PictureScene* scene_;
  const SkyLight* sky_;
  const Screen* screen_;
  SkyLight::Lamps lamps_;
  Vec3f background_;
  float nearest_ = 0, farthest_ = 1;  // depths between which strokes pale
  std::vector<Vec3f> facet_colors_, disc_colors_, stroke_colors_, dot_colors_;
};

}  // namespace

void PictureCamera::validate() const {
  require(aperture > 0 && aperture < radians(179), "picture aperture = ", degrees(aperture),
          " degrees: must lie in (0, 179)");
  require(eye.allFinite() && target.allFinite() && up.allFinite(), "picture camera: eye, target and up must be finite");
  require((target - eye).norm() > 0, "picture camera: eye and target coincide at ", eye.transpose());
  require(up.norm() > 0, "picture camera: up is (0,0,0)");
}

Pose PictureCamera::world_from_camera() const {
  validate();
  const Vec3 forward = (target - eye).normalized();
  const Vec3 across = forward.cross(up.normalized());
  const Vec3 right = across.norm() > 1e-6 ? Vec3(across.normalized()) : forward.unitOrthogonal();
  Pose pose = Pose::Identity();
  pose.linear() << right, forward.cross(right), forward;
  pose.translation() = eye;
  return pose;
}

PictureCamera camera_around(std::span<const Vec3> points, const Vec3& direction, double shape, const Vec3& up) {
  require(!points.empty(), "there is nothing to take a picture of: the scene is empty");
  require(shape > 0, "picture shape = ", shape, ": must be positive");
  constexpr double margin = 1.1;
  PictureCamera camera{direction, Vec3::Zero(), up};
  const Mat3 axes = camera.world_from_camera().linear();
  const double tangent_y = std::tan(camera.aperture / 2) / margin, tangent_x = tangent_y * shape;
  // An eye at (x, y, z) of the camera's axes has a point p in the picture where |p.x - x| <= tangent_x (p.z - z), so
  // that the left and the right border each bound x and z from one side; likewise y.
  constexpr double none = -std::numeric_limits<double>::infinity();
  double right = none, left = none, bottom = none, top = none, nearest = -none;
  for (const Vec3& point : points) {
    const Vec3 p = axes.transpose() * point;
    right = std::max(right, p.x() - tangent_x * p.z());
    left = std::max(left, -p.x() - tangent_x * p.z());
    bottom = std::max(bottom, p.y() - tangent_y * p.z());
    top = std::max(top, -p.y() - tangent_y * p.z());
    nearest = std::min(nearest, p.z());
  }
  const double z = std::min({-(left + right) / (2 * tangent_x), -(top + bottom) / (2 * tangent_y), nearest - 0.01});
  camera.eye = axes * Vec3((right - left) / 2, (bottom - top) / 2, z);
  camera.target = camera.eye + axes.col(2);
  return camera;
}

PictureCamera camera_around(const PictureScene& scene, const Vec3& direction, double shape, const Vec3& up) {
  return camera_around(scene.points(), direction, shape, up);
}

void RenderOptions::validate() const {
  require(width > 0 && height > 0 && width <= 16384 && height <= 16384, "picture size = ", width, "x", height,
          ": both sides must be 1 to 16384 pixels");
  require(samples_per_side >= 1 && samples_per_side <= 8, "picture samples_per_side = ", samples_per_side,
          ": must be 1 to 8");
}

Picture render(const PictureScene& scene, const PictureCamera& camera, const RenderOptions& options) {
  return render(scene, SkyLight(scene), camera, options);
}

Picture render(const PictureScene& scene, const SkyLight& sky, const PictureCamera& camera,
               const RenderOptions& options) {
  options.validate();
  const int samples = options.samples_per_side;
  const Screen screen(camera, options.width * samples, options.height * samples);
  const RenderFrame frame(scene, screen, samples);
  const Vec3f background = linear_light(options.background);
  const Shader shader(scene, sky, screen, camera.up, background);
  std::optional<Floor> floor;
  if (options.floor) floor.emplace(sky, shader.lamps(), camera.eye, camera.up, *options.floor);
  const SrgbTable srgb;

  Picture picture{options.width, options.height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height));
  const int bands = (options.height + band_rows - 1) / band_rows;
  parallel_for(static_cast<std::size_t>(bands), [&](std::size_t number) {
    const int top = static_cast<int>(number) * band_rows, bottom = std::min(options.height, top + band_rows);
    const RenderFrame::Band band = frame.draw(options.width * samples, top * samples, bottom * samples);
    const auto pixel_color = [&](int column, int row) {
      Vec3f sum = Vec3f::Zero();
      Shader::PixelLight known;
      int free = 0;
      for (int y = row * samples; y < (row + 1) * samples; ++y)
        for (int x = column * samples; x < (column + 1) * samples; ++x) {
          if (!frame.shows(band, x, y))
            ++free;
          else
            sum +=
                shader.color(frame.hit(band, x, y), static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, known);
        }
      if (free > 0) {
        const auto scale = static_cast<float>(samples);
        const Vec3f ray =
            screen.ray((static_cast<float>(column) + 0.5F) * scale, (static_cast<float>(row) + 0.5F) * scale);
        const Vec3f share = floor ? floor->at(screen.eye(), ray) : Vec3f::Ones();
        sum += static_cast<float>(free) * background.cwiseProduct(share);
      }
      return Vec3f(sum / static_cast<float>(samples * samples));
    };
    for (int row = top; row < bottom; ++row)
      for (int column = 0; column < options.width; ++column) {
        const Vec3f color = pixel_color(column, row);
        const std::size_t k = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(options.width) +
                                   static_cast<std::size_t>(column));
        for (int c = 0; c < 3; ++c) picture.rgb[k + static_cast<std::size_t>(c)] = srgb(color[c]);
      }
  });

  std::vector<PictureScene::Badge> badges = scene.badges;  // the farthest first
  const auto depth = [&](const PictureScene::Badge& badge) { return screen.in_camera(badge.place).z(); };
  std::stable_sort(badges.begin(), badges.end(), [&](const auto& a, const auto& b) { return depth(a) > depth(b); });
  for (const PictureScene::Badge& badge : badges) {
    if (depth(badge) <= 0) continue;
    const raster::Corner place = screen.project(screen.in_camera(badge.place));
    draw_badge(picture, place.x / static_cast<float>(samples), place.y / static_cast<float>(samples),
               std::max(7.0, options.height / 56.0), badge.number, badge.color);
  }
  return picture;
}

}  // namespace vantage
