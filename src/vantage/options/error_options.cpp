#include "vantage/options/error_options.hpp"

#include "vantage/core/error.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/robot/error_limits.hpp"

namespace vantage {
namespace {

using Vec6 = ErrorOptions::Vec6;

/// What is said of one robot, the real or the believed one, with the names of its options.
struct Said {
  Vec3 deviations = Vec3::Zero();
  Vec3 orientation = Vec3::Zero();  // degrees
  Vec6 mean = Vec6::Zero();
  std::optional<Vec6> covariance;
  Vec6 growth = Vec6::Zero();
};

Mat3 symmetric(const Vec6& upper) {
  Mat3 matrix;
  matrix << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4], upper[5];
  return matrix;
}

/// x, y, z as they are, pan, tilt and roll from degrees.
Vec6 in_radians(Vec6 values) {
  values.tail<3>() *= radians(1);
  return values;
}

void require_not_negative(const char* option, const char* unit, const auto& values) {
  require(values.allFinite() && (values.array() >= 0).all(), option, " = ", values.transpose(), " ", unit,
          ": standard deviations must not be negative");
  require((values.array() <= largest_position_error).all(), option, " = ", values.transpose(), " ", unit,
          ": standard deviations must be at most ", largest_position_error);
}

void require_covariance(const char* option, const std::optional<Vec6>& upper) {
  if (!upper) return;
  try {
    PositioningError{Vec3::Zero(), symmetric(*upper)}.validate();
  } catch (const InputError& error) {
    throw InputError(concat(option, " = ", upper->transpose(), " m^2 (xx xy xz yy yz zz): ", error.what()));
  }
}

std::shared_ptr<const PoseErrorModel> model_of(const Said& said) {
  PoseError error = PoseError::from_deviations(said.deviations, radians(1) * said.orientation);
  if (said.covariance) error.covariance.topLeftCorner<3, 3>() = symmetric(*said.covariance);
  error.mean = in_radians(said.mean);
  if (said.growth.isZero(0)) return std::make_shared<ConstantError>(error);
  return std::make_shared<GrowingError>(error, in_radians(said.growth));
}

Said robot_of(const ErrorOptions& o) {
  return {o.positioning_error, o.orientation_error, o.error_mean, o.error_covariance, o.error_growth};
}

Said believed_of(const ErrorOptions& o) {
  Said said = robot_of(o);
  if (o.believed_error) {
    const std::vector<double> n = numbers_from_text("believed-error", *o.believed_error, 3);
    said.deviations = Vec3(n[0], n[1], n[2]);
    said.covariance.reset();
  }
  if (o.believed_covariance) said.covariance = o.believed_covariance;
  if (o.believed_orientation_error) said.orientation = *o.believed_orientation_error;
  if (o.believed_mean) said.mean = *o.believed_mean;
  if (o.believed_growth) said.growth = *o.believed_growth;
  return said;
}

bool says_what_is_believed(const ErrorOptions& o) {
  return o.believed_error || o.believed_orientation_error || o.believed_mean || o.believed_covariance ||
         o.believed_growth;
}

/// That the error can be made of the options at all; what is wrong is said with the name of the option.
void require_possible(const char* option, const auto& make_error) {
  try {
    (void)make_error();
  } catch (const InputError& error) {
    throw InputError(concat(option, ": ", error.what()));
  }
}

std::shared_ptr<const PoseErrorModel> turntable(const Vec3& deviations, const Vec3& center) {
  return std::make_shared<TurntableArmError>(
      TurntableArmError::Deviations{radians(deviations[0]), radians(deviations[1]), deviations[2]}, center);
}

/// Growth goes along the axes, a covariance need not.
void require_independent(const char* covariance_option, const char* growth_option, const Said& said) {
  if (!said.covariance || said.growth.isZero(0)) return;
  const Mat3 covariance = symmetric(*said.covariance);
  require(PositioningError{Vec3::Zero(), covariance}.is_diagonal(), covariance_option, " = ",
          said.covariance->transpose(), ": with ", growth_option, " the axes must err independently (xy, xz and yz 0)");
}

void validate_learning(const ErrorOptions& o) {
  require(o.convolve != "off",
          "believed-error = learn: with convolve = off nothing would use what is learned; must be on, normalised or "
          "samples");
  require(!o.believed_orientation_error && !o.believed_mean && !o.believed_covariance && !o.believed_growth,
          "believed-error = learn: what is learned cannot be given too; leave out believed-orientation-error, "
          "believed-mean, believed-covariance and believed-growth");
}

}  // namespace

std::vector<std::string> believed_error_option_names() {
  return {"believed-error", "believed-orientation-error", "believed-mean", "believed-covariance", "believed-growth",
          "convolve",       "error-candidates",           "error-samples", "least-overlap"};
}

std::optional<ErrorLearnerOptions> ErrorOptions::learner_options() const {
  constexpr std::string_view word = "learn";
  if (!believed_error || !believed_error->starts_with(word)) return std::nullopt;
  ErrorLearnerOptions learner;
  if (*believed_error == word) return learner;
  require((*believed_error)[word.size()] == ':', "believed-error: '", *believed_error,
          "' must be SX,SY,SZ, learn or learn:SX,SY,SZ");
  const std::vector<double> n = numbers_from_text("believed-error", believed_error->substr(word.size() + 1), 3);
  learner.prior_deviation = Vec3(n[0], n[1], n[2]);
  require((learner.prior_deviation.array() > 0).all(), "believed-error = ", *believed_error,
          ": what is believed at first must be positive");
  return learner;
}

void ErrorOptions::validate_errors(const Vec3& center) const {
  require_one_of("convolve", convolve, {"off", "on", "normalised", "samples"});
  require_not_negative("positioning-error", "m", positioning_error);
  require_not_negative("orientation-error", "degrees", orientation_error);
  require_not_negative("error-growth", "per metre", error_growth);
  if (believed_orientation_error)
    require_not_negative("believed-orientation-error", "degrees", *believed_orientation_error);
  if (believed_growth) require_not_negative("believed-growth", "per metre", *believed_growth);
  require_covariance("error-covariance", error_covariance);
  require_covariance("believed-covariance", believed_covariance);
  require(!error_covariance || positioning_error.isZero(0),
          "error-covariance and positioning-error say the same thing twice: leave one out");
  if (turntable_error) {
    require_not_negative("turntable-error", "degrees, degrees, m", *turntable_error);
    require(positioning_error.isZero(0) && orientation_error.isZero(0) && error_mean.isZero(0) && !error_covariance &&
                error_growth.isZero(0),
            "turntable-error: leave out positioning-error, orientation-error, error-mean, error-covariance and "
            "error-growth");
  }
  require_independent("error-covariance", "error-growth", robot_of(*this));
  require_possible("positioning-error, error-mean, orientation-error or error-growth",
                   [&] { return robot_error(center); });
  if (learns_error()) {
    validate_learning(*this);
  } else {
    const Said believed = believed_of(*this);
    require_not_negative("believed-error", "m", believed.deviations);
    require(!believed_error || !believed_covariance,
            "believed-error and believed-covariance say the same thing twice: leave one out");
    require_independent("believed-covariance", "believed-growth", believed);
    require_possible("believed-error, believed-mean, believed-orientation-error or believed-growth",
                     [&] { return believed_error_model(center); });
  }
  if (convolve != "on" && convolve != "normalised") return;
  const View somewhere = view_towards(center + Vec3(1, 0, 0), center);
  const View elsewhere = view_towards(center + Vec3(0, 1, 0), center);
  require(learns_error() || turntable_error ||
              believed_error_model(center)->of_move(somewhere, elsewhere).keeps_orientation(),
          "convolve = ", convolve,
          ": convolution knows errors of the position alone; with an orientation error use "
          "convolve = samples, or believed-orientation-error = 0,0,0 to leave it out");
}

std::shared_ptr<const PoseErrorModel> ErrorOptions::robot_error(const Vec3& center) const {
  if (turntable_error) return turntable(*turntable_error, center);
  return model_of(robot_of(*this));
}

std::shared_ptr<const PoseErrorModel> ErrorOptions::believed_error_model(const Vec3& center) const {
  if (const auto learner = learner_options())
    return std::make_shared<ConstantError>(ErrorLearner(*learner).prediction());
  if (turntable_error && !says_what_is_believed(*this)) return turntable(*turntable_error, center);
  return model_of(believed_of(*this));
}

}  // namespace vantage
