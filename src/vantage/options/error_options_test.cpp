#include "vantage/options/error_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"
#include "vantage/options/reconstruct_options.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string complaint(const std::function<void(ReconstructOptions&)>& change) {
  ReconstructOptions options;
  change(options);
  try {
    options.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

ErrorOptions::Vec6 six(double a, double b, double c, double d, double e, double f) {
  return (ErrorOptions::Vec6() << a, b, c, d, e, f).finished();
}

const View here = view_towards({2, 0, 0}, {0, 0, 0});
const View there = view_towards({0, 2, 0}, {0, 0, 0});

TEST(ErrorOptions, NameWhatIsWrong) {
  EXPECT_THAT(complaint([](auto& o) { o.orientation_error[2] = -1; }),
              HasSubstr("orientation-error =  0  0 -1 degrees: standard deviations must not be negative"));
  EXPECT_THAT(complaint([](auto& o) { o.error_growth[0] = -1; }), HasSubstr("error-growth"));
  EXPECT_THAT(complaint([](auto& o) { o.believed_growth = six(0, 0, 0, 0, 0, -1); }), HasSubstr("believed-growth"));
  EXPECT_THAT(complaint([](auto& o) { o.believed_orientation_error = Vec3(0, 0, -1); }),
              HasSubstr("believed-orientation-error"));
  EXPECT_THAT(complaint([](auto& o) { o.believed_error = "0.1,-0.1,0"; }), HasSubstr("believed-error = "));
  EXPECT_THAT(complaint([](auto& o) { o.believed_error = "0.1,0.1"; }), HasSubstr("2 numbers; must have 3"));
  EXPECT_THAT(complaint([](auto& o) { o.believed_error = "lern"; }), HasSubstr("'lern' is not a number"));
  EXPECT_THAT(complaint([](auto& o) { o.error_covariance = six(0.01, 0.02, 0, 0.01, 0, 0.01); }),
              HasSubstr("error-covariance"));
  EXPECT_THAT(complaint([](auto& o) { o.believed_covariance = six(0.01, 0.02, 0, 0.01, 0, 0.01); }),
              HasSubstr("must be positive semi-definite"));
  EXPECT_THAT(complaint([](auto& o) {
                o.error_covariance = six(1, 0, 0, 1, 0, 1);
                o.positioning_error = Vec3::Ones();
              }),
              HasSubstr("twice"));
  EXPECT_THAT(complaint([](auto& o) {
                o.error_covariance = six(1, 0.1, 0, 1, 0, 1);
                o.error_growth[0] = 0.1;
              }),
              HasSubstr("independently"));
  EXPECT_THAT(complaint([](auto& o) {
                o.turntable_error = Vec3(1, 1, 0.01);
                o.orientation_error[0] = 1;
              }),
              HasSubstr("turntable-error: leave out"));
  EXPECT_THAT(complaint([](auto& o) { o.turntable_error = Vec3(1, -1, 0.01); }), HasSubstr("turntable-error"));
  EXPECT_THAT(complaint([](auto& o) { o.convolve = "sample"; }), HasSubstr("off, on, normalised, samples"));
  EXPECT_THAT(complaint([](auto& o) { o.error_samples = 7; }), HasSubstr("error-samples = 7"));
  EXPECT_THAT(complaint([](auto& o) { o.error_candidates = 0; }), HasSubstr("error-candidates = 0"));
  EXPECT_THAT(complaint([](auto& o) { o.least_overlap = 10; }), HasSubstr("least-overlap = 10"));
}

TEST(ErrorOptions, RefuseWhatConvolutionCannotAllowFor) {
  const auto turning = [](auto& o) {
    o.orientation_error = Vec3::Constant(3);
    o.convolve = "on";
  };
  EXPECT_THAT(complaint(turning), HasSubstr("convolve = on: convolution knows errors of the position alone"));
  EXPECT_EQ(complaint([&](auto& o) {
              turning(o);
              o.convolve = "samples";
            }),
            "");
  EXPECT_EQ(complaint([&](auto& o) {
              turning(o);
              o.believed_orientation_error = Vec3::Zero();
            }),
            "");
}

TEST(ErrorOptions, LearnOnlyWhereThereIsSomethingToLearnFromAndFor) {
  const auto learning = [](const auto& change) {
    return complaint([&](auto& o) {
      o.believed_error = "learn";
      o.convolve = "on";
      change(o);
    });
  };
  EXPECT_EQ(learning([](auto&) {}), "");
  EXPECT_THAT(learning([](auto& o) { o.convolve = "off"; }), HasSubstr("must be on, normalised or samples"));
  EXPECT_THAT(learning([](auto& o) { o.registration = "none"; }), HasSubstr("truth or icp"));
  EXPECT_THAT(learning([](auto& o) { o.believed_orientation_error = Vec3::Ones(); }), HasSubstr("leave out"));
}

TEST(ErrorOptions, ThePlannerBelievesWhatTheRobotDoesUnlessItIsToldOtherwise) {
  ErrorOptions options;
  options.positioning_error = Vec3::Constant(0.1);
  options.orientation_error = Vec3(1, 2, 3);
  options.error_mean = six(0.1, 0, 0, 0, 0, 5);
  options.error_growth = six(0.01, 0, 0, 0, 0, 0);
  const PoseError robot = options.robot_error(Vec3::Zero())->of_move(here, there);
  EXPECT_NEAR(std::sqrt(robot.covariance(0, 0)), 0.1 + 0.01 * std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(std::sqrt(robot.covariance(4, 4)), radians(2), 1e-12) << "tilt";
  EXPECT_NEAR(robot.mean[5], radians(5), 1e-12);
  const PoseError believed = options.believed_error_model(Vec3::Zero())->of_move(here, there);
  EXPECT_EQ(believed.covariance, robot.covariance);
  EXPECT_EQ(believed.mean, robot.mean);
  options.believed_error = "0.2,0.3,0.4";
  options.believed_growth = ErrorOptions::Vec6::Zero();
  const PoseError told = options.believed_error_model(Vec3::Zero())->of_move(here, there);
  EXPECT_NEAR(told.covariance(2, 2), 0.16, 1e-12);
  EXPECT_EQ(told.covariance(4, 4), robot.covariance(4, 4));
}

TEST(ErrorOptions, TakeACovarianceByItsUpperTriangle) {
  ErrorOptions options;
  options.error_covariance = six(0.04, 0.01, 0.02, 0.09, 0.005, 0.05);
  const Mat3 covariance = options.robot_error(Vec3::Zero())->of_move(here, there).position().covariance;
  Mat3 expected;
  expected << 0.04, 0.01, 0.02, 0.01, 0.09, 0.005, 0.02, 0.005, 0.05;
  EXPECT_EQ(covariance, expected);
}

TEST(ErrorOptions, AskTheTurntableForEachCandidate) {
  ErrorOptions options;
  options.turntable_error = Vec3(1, 0, 0);
  const auto model = options.believed_error_model(Vec3::Zero());
  EXPECT_NEAR(model->of_move(here, here).covariance(1, 1), std::pow(2 * radians(1), 2), 1e-12);
  EXPECT_NEAR(model->of_move(here, there).covariance(0, 0), std::pow(2 * radians(1), 2), 1e-12);
}

TEST(ErrorOptions, ErrorsThatNoRobotHasAreRefusedByName) {
  const auto refusal = [](const auto& change) {
    ReconstructOptions options;
    change(options);
    return input_error_of([&] { options.validate(); });
  };
  EXPECT_THAT(refusal([](auto& o) { o.positioning_error = Vec3(1e20, 0, 0); }), HasSubstr("positioning-error = 1e+20"));
  EXPECT_THAT(refusal([](auto& o) { o.error_mean[0] = 1e9; }), HasSubstr("error-mean"));
  EXPECT_THAT(refusal([](auto& o) { o.orientation_error = Vec3(0, 200, 0); }), HasSubstr("orientation-error"));
  EXPECT_THAT(refusal([](auto& o) {
                o.error_covariance = ErrorOptions::Vec6::Zero();
                (*o.error_covariance)[0] = 1e300;
              }),
              HasSubstr("error-covariance"));
  EXPECT_THAT(refusal([](auto& o) {
                o.convolve = "on";
                o.believed_error = "1e9,0,0";
              }),
              HasSubstr("believed-error"));
  EXPECT_THAT(refusal([](auto& o) {
                o.convolve = "on";
                o.believed_error = "learn:1e9,1,1";
              }),
              HasSubstr("prior deviation"));
}

}  // namespace
}  // namespace vantage
