#include "vantage/model/object_model.hpp"

#include <algorithm>
#include <bit>
#include <chrono>

#include "vantage/model/frame_offset.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

// Of a voxel: by how much surfaces have to move in the mean for the map to be made again, while scans come and at last.
constexpr double visible_move = 0.25;
constexpr double least_move = 0.05;

double passed_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

LabelCounts label_counts(const VoxelMap& map) {
  const auto outside = map.grid().size.cast<std::int64_t>().prod() - map.enclosure().size().cast<std::int64_t>().prod();
  return {map.count(Label::unmarked), map.count(Label::occupied), map.count(Label::empty) - outside,
          map.count(Label::occluded), map.count(Label::occplane)};
}

void note_map(ScanRecord& record, const VoxelMap& map) {
  record.labels = label_counts(map);
  record.mean_quality = map.mean_quality();
}

void note(ScanRecord& record, const Located& located) {
  record.registered = located.view;
  record.merged = located.accepted;
  record.overlap = located.overlap;
  record.residual = located.residual;
  record.verdict = located.verdict;
  record.detail = located.detail;
  record.pose_covariance = located.covariance;
  record.undetermined_directions = located.undetermined_directions;
}

/// A scan whose pose is known.
IntegrationReport merge(ObjectModel& model, int number, const Scan& scan, const PointCloud& points,
                        const ScanSurface* surface, const View& view, QualityReference quality) {
  const IntegrationReport report = integrate(model.map, scan, view, quality);
  model.surface.merge(points, view.world_from_sensor);
  if (surface != nullptr) model.surface.merge(*surface, view.world_from_sensor);
  model.cloud_growth.emplace_back(number, model.surface.cloud().size());
  return report;
}

/// The same for one that was just registered.
void merge(ObjectModel& model, ScanRecord& record, const Scan& scan, const PointCloud& points, const Located& located,
           const PoseEstimate& prior, QualityReference quality) {
  const IntegrationReport report =
      merge(model, record.scan, scan, points, located.surface.get(), record.registered, quality);
  record.new_occupied = report.new_occupied;
  record.taken_back = report.taken_back;
  if (located.surface && model.improves_poses) {
    model.graph.add(record.scan, *located.surface, prior, record.registered.world_from_sensor);
  }
}

/// Makes map, surface and graph again of the scans in `order`, where their records say.
void make_again(ObjectModel& model, const std::vector<int>& order, const Registrar& registrar,
                QualityReference quality) {
  model.cloud_growth.clear();
  model.map = VoxelMap(model.map.grid(), model.map.enclosure(), model.map.rule());
  model.surface = ModelSurface(model.surface.fused().spacing());
  for (const int number : order) {
    const ScanRecord& record = model.scans[static_cast<std::size_t>(number)];
    const Scan scan = model.kept.at(number).scan();
    const PointCloud points = points_of(scan);
    const std::shared_ptr<const ScanSurface> surface = registrar.surface_of(scan, points, record.believed);
    (void)merge(model, number, scan, points, surface.get(), record.registered, quality);
  }
}

/// The numbers of the scans in `by_number`, in the order that it has.
template <class Scans>
std::vector<int> numbers_in(const Scans& by_number) {
  std::vector<int> numbers;
  numbers.reserve(by_number.size());
  for (const auto& entry : by_number) numbers.push_back(entry.first);
  return numbers;
}

std::vector<int> merged_scans(const ObjectModel& model) { return numbers_in(model.cloud_growth); }

/// Improves all poses together, but for the map; returns whether some surface moves by more than `visible` metres.
/// Where none does, all stay where they are.
bool improve_poses(ObjectModel& model, double visible) {
  const ScanGraph::Improved improved = model.graph.improve();
  if (improved.largest_move <= visible) return false;
  model.graph.accept(improved);
  for (const auto& [number, pose] : improved.world_from_sensor)
    model.scans[static_cast<std::size_t>(number)].registered = View{pose};
  return true;
}

/// Lays all scans on each other again from where they are now, which is better known than when each came in, and
/// improves their poses together; until they hardly move.
void lay_again(ObjectModel& model, const Registrar& registrar) {
  constexpr int most_rounds = 3;
  constexpr std::size_t most_scans = 100;  // whose surfaces a graph keeps; of more the poses stay as they are
  const std::vector<int> order = merged_scans(model);
  if (order.size() > most_scans) return;
  std::vector<std::pair<int, std::shared_ptr<const ScanSurface>>> surfaces;  // in the order of merging
  for (const int number : order) {
    const Scan scan = model.kept.at(number).scan();
    const View& believed = model.scans[static_cast<std::size_t>(number)].believed;
    if (auto surface = registrar.surface_of(scan, points_of(scan), believed))
      surfaces.emplace_back(number, std::move(surface));
  }
  bool moves = true;
  for (int round = 0; moves && round < most_rounds; ++round) {
    model.graph = ScanGraph();
    for (const auto& [number, surface] : surfaces) {
      const ScanRecord& record = model.scans[static_cast<std::size_t>(number)];
      model.graph.add(number, *surface, model.priors.at(number), record.registered.world_from_sensor);
    }
    moves = improve_poses(model, least_move * model.map.grid().length);
  }
}

/// What the robot says of a pose, brought into the frame of the model.
PoseEstimate in_model(const ObjectModel& model, const PoseEstimate& in_robot) {
  std::vector<FoundPose> found;
  for (const int number : merged_scans(model)) {
    const auto prior = model.priors.find(number);
    if (prior == model.priors.end()) return in_robot;  // nobody estimates poses
    found.push_back({prior->second, model.scans[static_cast<std::size_t>(number)].registered.world_from_sensor});
  }
  return found.empty() ? in_robot : FrameOffset(found).in_model(in_robot);
}

std::int64_t occupied_in(const VoxelMap& map, const Box3& box) {
  const std::vector<Index3> occupied = map.occupied_voxels();
  return std::count_if(occupied.begin(), occupied.end(),
                       [&](const Index3& voxel) { return box.contains(map.grid().center(voxel)); });
}

WaitingScan waiting_scan(const VoxelMap& map, const PointCloud& points, const PoseEstimate& prior) {
  WaitingScan waiting{prior, {}, 0};
  for (const Vec3& point : points.points) waiting.box.extend(prior.mean * point);
  waiting.known_near = occupied_in(map, waiting.box);
  return waiting;
}

/// How much more of the surface near a refused scan has to be known before it is tried again. A share, so that the
/// number of trials grows with the logarithm of the surface.
enum class Growth { a_tenth, any };

bool has_grown(std::int64_t before, std::int64_t now, Growth growth) {
  return now > before + (growth == Growth::a_tenth ? before / 10 : 0);
}

constexpr std::size_t refusals_to_doubt = 3;
constexpr std::size_t most_doubted = 4;

/// Tries a waiting scan where enough has become known around it. Returns whether it came in.
bool try_one(ObjectModel& model, int number, Registrar& registrar, QualityReference quality, int now, Growth growth) {
  WaitingScan& waiting = model.waiting.at(number);
  const std::int64_t known = occupied_in(model.map, waiting.box);
  if (!has_grown(waiting.known_near, known, growth)) return false;
  waiting.known_near = known;
  ScanRecord& record = model.scans[static_cast<std::size_t>(number)];
  const Scan scan = model.kept.at(number).scan();
  const PointCloud points = points_of(scan);
  const Located located = registrar.locate_from(model.surface, scan, points, in_model(model, waiting.prior));
  note(record, located);
  if (!record.merged) return false;
  merge(model, record, scan, points, located, waiting.prior, quality);
  record.merged_after = now;
  model.waiting.erase(number);
  return true;
}

/// Tries waiting scans until none comes in any more; `now` is the scan after which this happens.
std::vector<int> try_again(ObjectModel& model, Registrar& registrar, QualityReference quality, int now, Growth growth) {
  std::vector<int> came_in;
  std::size_t before = 0;
  do {
    before = came_in.size();
    for (const int number : numbers_in(model.waiting)) {
      if (try_one(model, number, registrar, quality, now, growth)) came_in.push_back(number);
    }
  } while (came_in.size() > before);
  return came_in;
}

/// The model without the last `count` scans that were merged; they wait for themselves.
struct Doubt {
  ObjectModel model;
  std::map<int, WaitingScan> doubted;
};

Doubt without_last(const ObjectModel& model, std::size_t count, const Registrar& registrar, QualityReference quality) {
  Doubt doubt{model, {}};
  std::vector<int> order = merged_scans(model);
  for (std::size_t i = order.size() - count; i < order.size(); ++i) {
    const int number = order[i];
    ScanRecord& record = doubt.model.scans[static_cast<std::size_t>(number)];
    record.merged = false;
    record.merged_after.reset();
    record.new_occupied = 0;
    doubt.doubted.emplace(number,
                          waiting_scan(model.map, points_of(model.kept.at(number).scan()), model.priors.at(number)));
    doubt.model.graph.remove(number);
  }
  order.resize(order.size() - count);
  make_again(doubt.model, order, registrar, quality);
  return doubt;
}

/// The model that begins with this waiting scan; those that were merged wait.
Doubt begun_with(int first, const ObjectModel& model, Registrar& registrar, QualityReference quality) {
  Doubt doubt = without_last(model, model.cloud_growth.size(), registrar, quality);
  doubt.model.waiting.erase(first);
  ScanRecord& record = doubt.model.scans[static_cast<std::size_t>(first)];
  const Scan scan = doubt.model.kept.at(first).scan();
  const PointCloud points = points_of(scan);
  const Located located = registrar.locate(doubt.model.surface, scan, points, record.believed);
  note(record, located);
  merge(doubt.model, record, scan, points, located, doubt.model.priors.at(first), quality);
  return doubt;
}

/// Waiting scans that the model may begin with instead: a few, evenly picked. None where most scans fit, where the
/// first one is where it is by definition, or while too few more wait than the last time.
std::vector<int> other_beginnings(const ObjectModel& model) {
  constexpr std::size_t most = 4;
  const std::size_t waiting = model.waiting.size();
  const bool is_time = std::has_single_bit(waiting / refusals_to_doubt);
  const bool is_exact = model.priors.at(model.cloud_growth.front().first).covariance.isZero(0);
  if (!is_time || is_exact || 2 * model.cloud_growth.size() > waiting) return {};
  const std::vector<int> all = numbers_in(model.waiting);
  std::vector<int> picked;
  for (std::size_t i = 0; i < std::min(most, waiting); ++i)
    picked.push_back(all[i * waiting / std::min(most, waiting)]);
  return picked;
}

/// Tries waiting scans, whatever they were tried with before.
void try_all(ObjectModel& model, Registrar& registrar, QualityReference quality, int now) {
  for (auto& [number, waiting] : model.waiting) waiting.known_near = -1;
  (void)try_again(model, registrar, quality, now, Growth::any);
}

/// A scan that was put in a wrong place makes those after it contradict the model. Where several have been refused, the
/// scans that were merged last are doubted: if more come in without them than they are, they were wrong. Where most are
/// refused the first scan is doubted: it may show too little for others to be laid on it. Returns the numbers of those
/// that came in.
std::vector<int> reconsider(ObjectModel& model, Registrar& registrar, QualityReference quality, int now) {
  const std::vector<int> before = merged_scans(model);
  std::optional<ObjectModel> best;
  std::size_t most = before.size() + 1;
  const auto consider = [&](Doubt doubt) {
    // First those that were refused: the doubted ones would come in again as they did.
    try_all(doubt.model, registrar, quality, now);
    doubt.model.waiting.merge(doubt.doubted);
    try_all(doubt.model, registrar, quality, now);
    if (doubt.model.cloud_growth.size() <= most) return;
    most = doubt.model.cloud_growth.size();
    best = std::move(doubt.model);
  };
  for (std::size_t count = 1; count < std::min(before.size(), most_doubted + 1); ++count)
    consider(without_last(model, count, registrar, quality));
  for (const int first : other_beginnings(model)) consider(begun_with(first, model, registrar, quality));
  if (!best) return {};
  model = *std::move(best);
  std::vector<int> came_in;
  for (const int number : merged_scans(model)) {
    if (std::find(before.begin(), before.end(), number) == before.end()) came_in.push_back(number);
  }
  return came_in;
}

/// Registers the last of model.scans, which is new.
void add(ObjectModel& model, const Scan& scan, Registrar& registrar, QualityReference quality) {
  const int number = model.scans.back().scan;
  const auto record = [&]() -> ScanRecord& { return model.scans.back(); };
  auto start = Clock::now();
  const PointCloud points = points_of(scan);
  const PoseEstimate prior = registrar.prior(model.surface, record().believed);
  const Located located = model.cloud_growth.empty()
                              ? registrar.locate(model.surface, scan, points, record().believed)
                              : registrar.locate_from(model.surface, scan, points, in_model(model, prior));
  note(record(), located);
  if (registrar.estimates()) {
    if (!model.kept_in) model.kept_in = std::make_shared<ScratchFile>();
    model.kept.insert_or_assign(number, KeptScan(scan, model.kept_in));
    model.priors.insert_or_assign(number, prior);
  }
  record().timings.registration = passed_since(start);

  start = Clock::now();
  if (located.accepted) {
    record().merged_after = number;
    merge(model, record(), scan, points, located, prior, quality);
  } else if (registrar.estimates()) {
    model.waiting.insert_or_assign(number, waiting_scan(model.map, points, prior));
  }
  record().timings.integration = passed_since(start);

  start = Clock::now();
  std::vector<int> recovered;
  if (record().new_occupied > 0) recovered = try_again(model, registrar, quality, number, Growth::a_tenth);
  if (!located.accepted && !model.waiting.empty() && model.waiting.size() % refusals_to_doubt == 0)
    recovered = reconsider(model, registrar, quality, number);
  std::erase(recovered, number);
  record().recovered = std::move(recovered);
  if (model.graph.is_due() && improve_poses(model, visible_move * model.map.grid().length))
    make_again(model, merged_scans(model), registrar, quality);
  record().timings.registration += passed_since(start);
  note_map(record(), model.map);
}

}  // namespace

ScanRecord update(ObjectModel& model, const Scan& scan, const View& believed, Registrar& registrar,
                  QualityReference quality) {
  ScanRecord& record = model.scans.emplace_back();
  record.scan = static_cast<int>(model.scans.size()) - 1;
  record.believed = believed;
  try {
    add(model, scan, registrar, quality);
  } catch (...) {
    model.scans.pop_back();
    throw;
  }
  ScanRecord result = std::move(model.scans.back());
  model.scans.pop_back();
  return result;
}

std::vector<int> conclude(ObjectModel& model, Registrar& registrar, QualityReference quality) {
  if (model.scans.empty()) return {};
  const int last = model.scans.back().scan;
  std::vector<int> came_in = try_again(model, registrar, quality, last, Growth::any);
  ScanRecord& record = model.scans.back();
  record.recovered.insert(record.recovered.end(), came_in.begin(), came_in.end());
  (void)improve_poses(model, least_move * model.map.grid().length);
  if (model.graph.size() > 1) {
    lay_again(model, registrar);
    make_again(model, merged_scans(model), registrar, quality);
  }
  note_map(model.scans.back(), model.map);
  return came_in;
}

std::vector<std::int64_t> gains(const std::vector<ScanRecord>& scans) {
  std::vector<std::int64_t> gained(scans.size(), 0);
  for (const ScanRecord& scan : scans) {
    if (scan.merged_after) gained.at(static_cast<std::size_t>(*scan.merged_after)) += scan.new_occupied;
  }
  return gained;
}

bool teach(ErrorLearner& learner, const ScanRecord& record) {
  if (!record.merged || record.scan == 0) return false;
  learner.add(record.commanded, record.registered);
  return true;
}

}  // namespace vantage
