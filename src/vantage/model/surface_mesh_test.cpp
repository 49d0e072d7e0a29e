#include "vantage/model/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <map>

#include "vantage/core/random.hpp"
#include "vantage/model/surface_field.hpp"

namespace vantage {
namespace {

/// How many directed edges occur without their opposite, and how many more than once.
struct EdgeCount {
  int open = 0, doubled = 0;
};

EdgeCount count_edges(const std::vector<Index3>& triangles) {
  std::map<std::pair<int, int>, int> directed;
  for (const Index3& triangle : triangles) {
    for (int k = 0; k < 3; ++k) ++directed[{triangle[k], triangle[(k + 1) % 3]}];
  }
  EdgeCount count;
  for (const auto& [edge, times] : directed) {
    count.open += directed.contains({edge.second, edge.first}) ? 0 : 1;
    count.doubled += times > 1 ? 1 : 0;
  }
  return count;
}

/// Blocks that fill a cube of `blocks`^3, with `distance` at each node, seen by `frames` frames.
template <class Distance>
SurfaceBlocks filled(int blocks, int frames, const Distance& distance) {
  SurfaceBlocks result(1);
  std::vector<Index3> keys;
  for (int z = 0; z < blocks; ++z) {
    for (int y = 0; y < blocks; ++y) {
      for (int x = 0; x < blocks; ++x) keys.emplace_back(x, y, z);
    }
  }
  result.make(keys);
  for (const auto& block : result.all()) {
    for (std::size_t n = 0; n < SurfaceBlock::size; ++n) {
      const int node = static_cast<int>(n);
      const Index3 at = 8 * block->key + Index3(node & 7, node >> 3 & 7, node >> 6);
      const float value = distance(at);
      for (int frame = 0; frame < frames; ++frame)
        block->add(n, {value, 1e6F, Vec3f::UnitX(), 1, static_cast<std::uint16_t>(frame)});
    }
  }
  return result;
}

Box3 box_of(int blocks) { return {Vec3::Zero(), Vec3::Constant(8.0 * blocks)}; }

TEST(SurfaceMesh, IsAClosedManifoldWhateverTheSigns) {
  Random random(3);
  const SurfaceBlocks blocks = filled(2, 1, [&](const Index3& at) {
    const bool is_border = at.minCoeff() == 0 || at.maxCoeff() == 15;
    return is_border ? 3.0F : static_cast<float>(random.uniform() - 0.5);
  });
  const SurfaceNet net = surface_net(SurfaceField(blocks), box_of(2));
  ASSERT_GT(net.triangles.size(), 5000U);
  EXPECT_EQ(count_edges(net.triangles).open, 0);
  EXPECT_EQ(count_edges(net.triangles).doubled, 0);
  const MeasuredMesh mesh = closed_mesh(net, 1);
  EXPECT_EQ(count_edges(mesh.mesh.triangles).open, 0);
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t)
    EXPECT_NE(mesh.mesh.corner(t, 0), mesh.mesh.corner(t, 1));
}

float ball(const Index3& at, const Vec3& center, double radius) {
  return static_cast<float>((at.cast<double>() - center).norm() - radius);
}

TEST(SurfaceMesh, DropsPartsThatTooFewFramesSaw) {
  const auto two_balls = [](const Index3& at) { return std::min(ball(at, {5, 8, 8}, 3), ball(at, {12, 8, 8}, 2)); };
  const SurfaceNet net = surface_net(SurfaceField(filled(2, 2, two_balls)), box_of(2));
  EXPECT_FALSE(open_mesh(net, 2).empty());
  EXPECT_TRUE(open_mesh(net, 3).empty());
  const SurfaceNet seen_more = surface_net(SurfaceField(filled(2, 3, two_balls)), box_of(2));
  EXPECT_EQ(open_mesh(seen_more, 3).mesh.triangles.size(), net.triangles.size());
}

TEST(SurfaceMesh, SplitsVerticesWhereTheBorderTouchesItself) {
  SurfaceNet net;
  net.vertices.resize(5);
  for (std::size_t i = 0; i < 5; ++i) {
    net.vertices[i].position = Vec3f::Constant(static_cast<float>(i));
    net.vertices[i].is_seen = true;
  }
  net.triangles = {{0, 1, 2}, {0, 3, 4}};
  const MeasuredMesh mesh = open_mesh(net, 0);
  EXPECT_EQ(mesh.mesh.vertices.size(), 6U);
  EXPECT_EQ(mesh.mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.mesh.corner(0, 0), mesh.mesh.corner(1, 0));
}

}  // namespace
}  // namespace vantage
