#include "vantage/report/render_frame.hpp"

namespace vantage {
namespace {

constexpr double nearest_depth = 1e-3;  // metres; solids that come nearer are left out
// Strokes along the edges of a facet lie in front of it, whatever the rounding.
constexpr float stroke_lift = 1.002F;

Vec3f facing_normal(const PictureScene::Disc& disc, const Vec3f& eye) {
  return disc.normal.isZero() ? Vec3f((eye - disc.center).normalized()) : disc.normal;
}

}  // namespace

RenderFrame::RenderFrame(const PictureScene& scene, const Screen& screen, int samples_per_pixel)
    : scene_(&scene),
      screen_(&screen),
      first_disc_(scene.facets.size()),
      first_stroke_(first_disc_ + scene.discs.size()),
      first_dot_(first_stroke_ + scene.strokes.size()) {
  const auto scale = static_cast<float>(samples_per_pixel);
  faces_.reserve(scene.facets.size() + 2 * scene.strokes.size());
  for (std::size_t i = 0; i < scene.facets.size(); ++i) {
    Face face;
    face.id = static_cast<std::uint32_t>(i);
    bool in_front = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 corner = screen.in_camera(scene.facets[i].corner[k]);
      in_front = in_front && corner.z() > nearest_depth;
      if (in_front) face.corners[k] = screen.project(corner);
    }
    if (in_front) faces_.push_back(face);
  }
  for (std::size_t i = 0; i < scene.discs.size(); ++i) {
    const Vec3 center = screen.in_camera(scene.discs[i].center);
    if (center.z() <= nearest_depth + scene.discs[i].radius) continue;
    const double reach = screen.focal() * scene.discs[i].radius / (center.z() - scene.discs[i].radius);
    discs_.push_back({screen.project(center), static_cast<float>(reach), static_cast<std::uint32_t>(first_disc_ + i)});
  }
  for (std::size_t i = 0; i < scene.strokes.size(); ++i) add_stroke(i, scale);
  for (std::size_t i = 0; i < scene.dots.size(); ++i) {
    const Vec3 center = screen.in_camera(scene.dots[i].center);
    if (center.z() > nearest_depth)
      dots_.push_back(
          {screen.project(center), scene.dots[i].radius * scale, static_cast<std::uint32_t>(first_dot_ + i)});
  }
}

void RenderFrame::add_stroke(std::size_t index, float samples_per_pixel) {
  const PictureScene::Stroke& stroke = scene_->strokes[index];
  Vec3 from = screen_->in_camera(stroke.from), to = screen_->in_camera(stroke.to);
  if (from.z() > to.z()) std::swap(from, to);
  if (to.z() <= nearest_depth) return;
  if (from.z() < nearest_depth) from = to + (from - to) * ((to.z() - nearest_depth) / (to.z() - from.z()));
  raster::Corner a = screen_->project(from), b = screen_->project(to);
  a.nearness *= stroke_lift;
  b.nearness *= stroke_lift;
  const float dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  const float half = stroke.width * samples_per_pixel / 2;
  // The ends reach out by half the width, so that the pieces of a path join without gaps.
  const float ux = length > 0 ? dx / length * half : half, uy = length > 0 ? dy / length * half : 0;
  const raster::Corner a0{a.x - ux - uy, a.y - uy + ux, a.nearness}, a1{a.x - ux + uy, a.y - uy - ux, a.nearness};
  const raster::Corner b0{b.x + ux - uy, b.y + uy + ux, b.nearness}, b1{b.x + ux + uy, b.y + uy - ux, b.nearness};
  const auto id = static_cast<std::uint32_t>(first_stroke_ + index);
  faces_.push_back({{a0, a1, b1}, id});
  faces_.push_back({{a0, b1, b0}, id});
}

RenderFrame::Band RenderFrame::draw(int width, int top, int bottom) const {
  Band band(width, top, bottom);
  for (const Face& face : faces_)
    raster::fill(face.corners, band.window(), [&](int x, int y, float nearness) { band.put(x, y, nearness, face.id); });
  for (const Circle& disc : discs_) draw_disc(band, disc);
  for (const Circle& dot : dots_) {
    const float reach = dot.reach * dot.reach;
    raster::for_each_in_square(dot.center, dot.reach, band.window(), [&](int x, int y) {
      const float dx = static_cast<float>(x) + 0.5F - dot.center.x, dy = static_cast<float>(y) + 0.5F - dot.center.y;
      if (dx * dx + dy * dy <= reach) band.put(x, y, dot.center.nearness * stroke_lift, dot.id);
    });
  }
  return band;
}

void RenderFrame::draw_disc(Band& band, const Circle& circle) const {
  const PictureScene::Disc& disc = scene_->discs[circle.id - first_disc_];
  const Vec3f eye = screen_->eye(), normal = facing_normal(disc, eye);
  const float height = normal.dot(disc.center - eye);
  raster::for_each_in_square(circle.center, circle.reach, band.window(), [&](int x, int y) {
    const Vec3f ray = screen_->ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
    const float depth = height / normal.dot(ray);
    if (depth > 0 && (eye + depth * ray - disc.center).squaredNorm() <= disc.radius * disc.radius)
      band.put(x, y, 1 / depth, circle.id);
  });
}

RenderFrame::Hit RenderFrame::hit(const Band& band, int x, int y) const {
  const Band::Slot& slot = band.slots_[band.place(x, y)];
  if (slot.id < first_disc_) return {Kind::facet, slot.id, slot.nearness};
  if (slot.id < first_stroke_) return {Kind::disc, slot.id - first_disc_, slot.nearness};
  if (slot.id < first_dot_) return {Kind::stroke, slot.id - first_stroke_, slot.nearness};
  return {Kind::dot, slot.id - first_dot_, slot.nearness};
}

}  // namespace vantage
