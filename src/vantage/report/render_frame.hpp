#pragma once

#include <vector>

#include "vantage/report/screen.hpp"

namespace vantage {

/// The primitives of a scene on a screen, and which of them is nearest at each sample of a band of rows.
class RenderFrame {
 public:
  enum class Kind { facet, disc, stroke, dot };
  /// What a sample shows: primitive `index` of its kind in the scene.
  struct Hit {
    Kind kind = Kind::facet;
    std::size_t index = 0;
    float nearness = 0;
  };
  /// The nearest primitive of every sample in the rows [top, bottom).
  class Band {
   public:
    Band(int width, int top, int bottom)
        : width_(width),
          top_(top),
          bottom_(bottom),
          slots_(static_cast<std::size_t>(width) * static_cast<std::size_t>(bottom - top)) {}
    [[nodiscard]] raster::Window window() const { return {0, top_, width_, bottom_}; }
    /// The first of equals stays.
    void put(int x, int y, float nearness, std::uint32_t id) {
      Slot& slot = slots_[place(x, y)];
      if (nearness > slot.nearness) slot = {nearness, id};
    }

   private:
    friend class RenderFrame;
    static constexpr std::uint32_t nothing = ~std::uint32_t{0};
    struct Slot {
      float nearness = 0;
      std::uint32_t id = nothing;
    };
    [[nodiscard]] std::size_t place(int x, int y) const {
      return static_cast<std::size_t>(y - top_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    int width_, top_, bottom_;
    std::vector<Slot> slots_;
  };

  /// `samples_per_pixel` turns the widths of strokes and dots into samples. Scene and screen must outlive the frame.
  RenderFrame(const PictureScene& scene, const Screen& screen, int samples_per_pixel);
  [[nodiscard]] Band draw(int width, int top, int bottom) const;
  /// False where the sample shows nothing.
  [[nodiscard]] bool shows(const Band& band, int x, int y) const {
    return band.slots_[band.place(x, y)].id != Band::nothing;
  }
  /// What the sample shows; it must show something.
  [[nodiscard]] Hit hit(const Band& band, int x, int y) const;

 private:
  struct Face {
    raster::Triangle corners;
    std::uint32_t id = 0;
  };
  struct Circle {
    raster::Corner center;
    float reach = 0;  // samples
    std::uint32_t id = 0;
  };
  void add_stroke(std::size_t index, float samples_per_pixel);
  void draw_disc(Band& band, const Circle& circle) const;

  const PictureScene* scene_;
  const Screen* screen_;
  std::vector<Face> faces_;  // facets, then strokes
  std::vector<Circle> discs_, dots_;
  std::size_t first_disc_, first_stroke_, first_dot_;  // ids of the kinds follow one another
};

}  // namespace vantage
