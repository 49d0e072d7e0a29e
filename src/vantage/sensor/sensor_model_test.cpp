#include "vantage/sensor/sensor_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

TEST(SensorModel, PresetsGiveThePublishedFigures) {
  // Nguyen, Izadi and Lovell: 1.2 mm + 1.9 mm (z - 0.4)^2.
  const SensorModel primesense = sensor_by_name("primesense");
  EXPECT_NEAR(primesense.noise(0.4), 0.0012, 1e-9);
  EXPECT_NEAR(primesense.noise(2), 0.0012 + 0.0019 * 1.6 * 1.6, 1e-9);
  // Khoshelham and Elberink: steps of 7 cm at 5 m.
  EXPECT_NEAR(primesense.step(5), 0.07, 0.002);
  // Intel: 2.5 mm at 1 m, 15.5 mm at 9 m.
  const SensorModel l515 = sensor_by_name("realsense-l515");
  EXPECT_NEAR(l515.noise(1), 0.0025, 1e-9);
  EXPECT_NEAR(l515.noise(9), 0.0155, 1e-9);
  // 0.08 pixels of disparity at 2 m, focal length 424 pixels, baseline 50 mm.
  EXPECT_NEAR(sensor_by_name("realsense-d435").noise(2), 4 * 0.08 / (424 * 0.05), 1e-9);
  EXPECT_LT(sensor_by_name("azure-kinect").noise(3.86), 0.017) << "Microsoft's limit at the end of its range";
  EXPECT_TRUE(sensor_by_name("ideal").is_ideal());
}

TEST(SensorModel, PresetsAreValidAtAllDepths) {
  const std::vector<std::string> names = sensor_names();
  EXPECT_EQ(names.size(), 6U);
  for (const std::string& name : names) {
    const SensorModel sensor = sensor_by_name(name);
    EXPECT_NO_THROW(sensor.validate()) << name;
    for (double depth = 0.1; depth < 10; depth += 0.1) {
      EXPECT_GE(sensor.noise(depth), 0) << name << " at " << depth;
      EXPECT_GE(sensor.sigma(depth), sensor.noise(depth)) << name << " at " << depth;
    }
  }
}

TEST(SensorModel, DeviationGrowsWithIncidenceUntilNobodyKnows) {
  const SensorModel sensor = sensor_with({0.001, 0, 0.0002});
  EXPECT_DOUBLE_EQ(sensor.noise(1, 1), 0.001);
  EXPECT_NEAR(sensor.noise(1, std::cos(radians(60))), 0.001 + 3 * 0.0002, 1e-12);
  EXPECT_EQ(sensor.noise(1, 0), sensor.noise(1, SensorModel::least_cosine));
}

TEST(SensorModel, RoundsDepthsOrDisparities) {
  const SensorModel millimetres{.quantum = 0.001};
  EXPECT_DOUBLE_EQ(millimetres.quantised(1.2344), 1.234);
  EXPECT_NEAR(millimetres.sigma(1), 0.001 / std::sqrt(12.0), 1e-12);
  const SensorModel disparities{.disparity_quantum = 0.1};
  EXPECT_NEAR(disparities.quantised(2.02), 2, 1e-12) << "1/z = 0.495 becomes 0.5";
  EXPECT_NEAR(disparities.quantised(2.3), 2.5, 1e-12);
  EXPECT_TRUE(std::isinf(disparities.quantised(30)));
  EXPECT_NEAR(disparities.step(2), 0.4, 1e-12);
}

TEST(SensorModel, DropoutsAddUp) {
  const SensorModel sensor{.dropout = 0.2, .dropout_from_incidence = radians(30)};
  EXPECT_NEAR(sensor.dropout_at(0), 0.2, 1e-12);
  EXPECT_NEAR(sensor.dropout_at(radians(60)), 1 - 0.8 * 0.5, 1e-12);
  EXPECT_NEAR(sensor.dropout_at(radians(90)), 1, 1e-12);
}

std::string complaint(const SensorModel& sensor) {
  try {
    sensor.validate();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(SensorModel, NamesWhatIsWrong) {
  EXPECT_THAT(complaint({.constant = -0.1}), HasSubstr("constant = -0.1 m: must be from 0 to 1000000"));
  EXPECT_THAT(complaint({.quadratic = -2}), HasSubstr("quadratic = -2 1/m"));
  EXPECT_THAT(complaint({.linear = -1}), HasSubstr("linear = -1: makes the deviation negative"));
  EXPECT_THAT(complaint({.quantum = -1}), HasSubstr("quantum = -1 m"));
  EXPECT_THAT(complaint({.mixed = 1.5}), HasSubstr("mixed = 1.5: must be a share"));
  EXPECT_THAT(complaint({.dropout_from_incidence = radians(90)}), HasSubstr("dropout_from_incidence = 90 degrees"));
  try {
    (void)sensor_by_name("kinect");
    ADD_FAILURE() << "no such preset";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("sensor = 'kinect': must be one of: ideal, primesense, realsense-d435"));
  }
}

TEST(SensorModel, DescribesItsDeviation) {
  EXPECT_EQ(description(sensor_with({0.0005, 0.0019})), "0.5 mm + 1.9 mm/m2 z2");
  EXPECT_EQ(description(sensor_by_name("primesense")), "1.5 mm - 1.52 mm/m z + 1.9 mm/m2 z2 + 0.1 mm tan2(incidence)");
}

}  // namespace
}  // namespace vantage
