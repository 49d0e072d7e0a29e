#include "vantage/candidates/candidates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const Vec3 center(0.5, -1, 2);

void expect_all_look_at_the_centre(const Candidates& candidates) {
  for (const View& view : candidates.views) {
    const Vec3 towards = (candidates.center - view.position()).normalized();
    ASSERT_LT((view.axis() - towards).norm(), 1e-14);
  }
}

TEST(ViewSphere, CountsDistancesAndDirections) {
  for (const int count : {20, 80, 320, 1280}) {
    const Candidates candidates = view_sphere(count, 2, center);
    ASSERT_EQ(candidates.views.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(candidates.kind, Candidates::Kind::sphere);
    EXPECT_FALSE(candidates.grid);
    for (const View& view : candidates.views) ASSERT_NEAR((view.position() - center).norm(), 2, 1e-14);
    expect_all_look_at_the_centre(candidates);
  }
}

TEST(ViewSphere, TheTwentyAreTheFaceCentresOfTheIcosahedron) {
  // The face with corners (1, phi, 0), (phi, 0, 1), (0, 1, phi), all three permuted into each other, points to (1,1,1).
  const Candidates candidates = view_sphere(20, 1, Vec3::Zero());
  const Vec3 diagonal = Vec3::Ones().normalized();
  int on_diagonal = 0;
  for (const View& view : candidates.views) {
    if ((view.position() - diagonal).norm() < 1e-12) ++on_diagonal;
    // Neighbouring faces of an icosahedron enclose acos(sqrt(5)/3) = 41.81 degrees.
    double nearest = 0;
    for (const View& other : candidates.views) {
      if (&other != &view) nearest = std::max(nearest, view.position().dot(other.position()));
    }
    EXPECT_NEAR(nearest, std::sqrt(5.0) / 3, 1e-12);
  }
  EXPECT_EQ(on_diagonal, 1);
}

TEST(ViewSphere, EightyViewsAreSpreadEvenlyAndOpposite) {
  const Candidates candidates = view_sphere(80, 1, Vec3::Zero());
  Vec3 sum = Vec3::Zero();
  for (const View& view : candidates.views) {
    sum += view.position();
    double opposite = 1;
    double nearest = -1;
    for (const View& other : candidates.views) {
      const double cosine = view.position().dot(other.position());
      opposite = std::min(opposite, cosine);
      if (&other != &view) nearest = std::max(nearest, cosine);
    }
    EXPECT_NEAR(opposite, -1, 1e-12);
    EXPECT_GT(degrees(std::acos(nearest)), 15);
    EXPECT_LT(degrees(std::acos(nearest)), 30);
  }
  EXPECT_LT(sum.norm(), 1e-12);
}

TEST(ViewSphere, OtherCountsAreErrors) {
  for (const int count : {0, -80, 1, 79, 81, 100, 2000}) {
    EXPECT_THAT([=] { (void)view_sphere(count, 2, Vec3::Zero()); }, ThrowsMessage<InputError>(HasSubstr("20*4^k")));
  }
  EXPECT_THAT([] { (void)view_sphere(80, 0, Vec3::Zero()); }, ThrowsMessage<InputError>(HasSubstr("radius = 0")));
}

TEST(ViewCube, ThePapersCubeHas1932Views) {
  const Candidates candidates = candidates_from_text("cube:17:4.1:0.82:1.9", Vec3::Zero());
  EXPECT_EQ(candidates.views.size(), 1932U);
  EXPECT_EQ(candidates.kind, Candidates::Kind::grid);
  expect_all_look_at_the_centre(candidates);
  // The enclosure of 55 voxels of 2 cm reaches to 0.55 m; the spec counts 8 views in it.
  int in_enclosure = 0;
  for (const View& view : candidates.views) {
    const double distance = view.position().norm();
    ASSERT_GE(distance, 0.82);
    ASSERT_LE(distance, 1.9);
    if (view.position().cwiseAbs().maxCoeff() < 0.55) ++in_enclosure;
  }
  EXPECT_EQ(in_enclosure, 8);
}

TEST(ViewCube, CellsTellPositions) {
  const Candidates candidates = view_cube(4, Vec3(4, 2, 1), 0, 10, center);
  ASSERT_TRUE(candidates.grid);
  ASSERT_EQ(candidates.views.size(), 64U);
  EXPECT_TRUE(candidates.grid->spacing.isApprox(Vec3(1, 0.5, 0.25)));
  for (std::size_t i = 0; i < 64; ++i) {
    const Index3& cell = candidates.grid->cell_of_view[i];
    EXPECT_EQ(cell.x() + 4 * cell.y() + 16 * cell.z(), static_cast<int>(i)) << "x fastest";
    const Vec3 corner = center - Vec3(2, 1, 0.5);
    const Vec3 expected = corner + (cell.cast<double>() + Vec3::Constant(0.5)).cwiseProduct(candidates.grid->spacing);
    EXPECT_LT((candidates.views[i].position() - expected).norm(), 1e-14);
  }
}

TEST(ViewCube, TheCentreItselfIsLeftOut) { EXPECT_EQ(view_cube(3, Vec3::Ones(), 0, 10, center).views.size(), 26U); }

TEST(CandidatesFromText, GivesWhatTheFunctionsGive) {
  const Candidates sphere = candidates_from_text("sphere:80:2", center);
  EXPECT_EQ(sphere.views[17].position(), view_sphere(80, 2, center).views[17].position());
  const Candidates cube = candidates_from_text("cube:4:4,2,1:0:10", center);
  EXPECT_EQ(cube.views[17].position(), view_cube(4, Vec3(4, 2, 1), 0, 10, center).views[17].position());
}

TEST(CandidatesFromText, ErrorsNameTheBadPart) {
  const auto error_of = [](const char* text) { return [=] { (void)candidates_from_text(text, Vec3::Zero()); }; };
  const auto says = [](const char* text) { return ThrowsMessage<InputError>(HasSubstr(text)); };
  EXPECT_THAT(error_of("ring:80:2"), says("must begin with sphere: or cube:"));
  EXPECT_THAT(error_of(""), says("must begin with sphere: or cube:"));
  EXPECT_THAT(error_of("sphere:80"), says("sphere:N:RADIUS"));
  EXPECT_THAT(error_of("sphere:80:2:1"), says("sphere:N:RADIUS"));
  EXPECT_THAT(error_of("sphere:eighty:2"), says("N = 'eighty' is not a number"));
  EXPECT_THAT(error_of("sphere:80.5:2"), says("N = '80.5' must be a whole number"));
  EXPECT_THAT(error_of("sphere:80:2m"), says("RADIUS = '2m' is not a number"));
  EXPECT_THAT(error_of("sphere:80: 2"), says("RADIUS = ' 2' is not a number"));
  EXPECT_THAT(error_of("sphere:80:nan"), says("RADIUS = 'nan' is not a number"));
  EXPECT_THAT(error_of("sphere:80:-2"), says("radius = -2"));
  EXPECT_THAT(error_of("sphere:81:2"), says("20*4^k"));
  EXPECT_THAT(error_of("cube:17:4.1:0.82"), says("cube:N:SIDE:INNER:OUTER"));
  EXPECT_THAT(error_of("cube:0:4.1:0.82:1.9"), says("n = 0"));
  EXPECT_THAT(error_of("cube:17:4,1:0.82:1.9"), says("one length or three"));
  EXPECT_THAT(error_of("cube:17:0:0.82:1.9"), says("must be positive"));
  EXPECT_THAT(error_of("cube:17:4.1:1.9:0.82"), says("the outer must be greater"));
  EXPECT_THAT(error_of("cube:3:1:5:6"), says("no cell lies between"));
}

}  // namespace
}  // namespace vantage
