#include "bindings.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/map/scan.hpp"

namespace vantage::python {
namespace {

QualityReference quality_reference(const std::string& quality) {
  require(quality == "axis" || quality == "ray", "quality = '", quality, "': must be axis or ray");
  return quality == "ray" ? QualityReference::ray : QualityReference::axis;
}

Scan scan_of_points(const DoubleArray& points, const DoubleArray& origins, const std::optional<FloatArray>& normals,
                    const Vec3& axis) {
  PointScan scan;
  scan.points = points_from(points, "points");
  scan.origins = points_from(origins, "origins");
  require(scan.origins.size() == 1 || scan.origins.size() == scan.points.size(), "origins: there are ",
          scan.origins.size(), "; must be 1 or one for each of the ", scan.points.size(), " points");
  if (normals) {
    const auto span = normals_in(*normals, scan.points.size());
    scan.normals.assign(span.begin(), span.end());
  }
  require(axis.allFinite() && axis.norm() > 0, "axis = ", axis.transpose(), ": must be a direction");
  scan.axis = axis.normalized();
  return scan;
}

IntegrationReport integrate_scan(VoxelMap& map, const Scan& scan, const View& view, const std::string& quality) {
  const QualityReference reference = quality_reference(quality);
  const py::gil_scoped_release release;
  return integrate(map, scan, view, reference);
}

IntegrationReport integrate_image(VoxelMap& map, const RangeImage& image, const View& view,
                                  const std::optional<FloatArray>& normals, const std::string& quality) {
  const QualityReference reference = quality_reference(quality);
  std::vector<Vec3f> computed;
  std::span<const Vec3f> used;
  if (normals) used = normals_in(*normals, image.depth.size());
  const py::gil_scoped_release release;
  image.validate();
  if (!normals) used = computed = range_image_normals(image);
  return integrate(map, image, used, view, reference);
}

}  // namespace

void bind_scans(py::module_& module) {
  py::class_<PointCloud>(module, "PointCloud", "Surface points with unit normals, metres, in one frame.")
      .def(py::init([](const DoubleArray& points, const std::optional<DoubleArray>& normals) {
             PointCloud cloud{points_from(points, "points"), {}};
             cloud.normals = normals ? points_from(*normals, "normals") : std::vector<Vec3>(cloud.size(), Vec3::Zero());
             require(cloud.normals.size() == cloud.size(), "normals: there are ", cloud.normals.size(),
                     "; must be as many as points, ", cloud.size());
             return cloud;
           }),
           py::arg("points"), py::arg("normals") = py::none(), "points and normals: (n, 3), copied.")
      .def_property_readonly(
          "points",
          [](py::object self) {
            auto& cloud = self.cast<PointCloud&>();
            return py::array_t<double>({static_cast<py::ssize_t>(cloud.size()), py::ssize_t{3}},
                                       reinterpret_cast<const double*>(cloud.points.data()), self);
          },
          "float64 (n, 3), metres: a view, no copy.")
      .def_property_readonly(
          "normals",
          [](py::object self) {
            auto& cloud = self.cast<PointCloud&>();
            return py::array_t<double>({static_cast<py::ssize_t>(cloud.size()), py::ssize_t{3}},
                                       reinterpret_cast<const double*>(cloud.normals.data()), self);
          },
          "float64 (n, 3), zero where unknown: a view, no copy.")
      .def("__len__", &PointCloud::size);

  py::class_<ScanHolder>(module, "Scan", "One scan of any depth sensor, in its own frame.")
      .def(py::init([](const RangeImage& image) { return ScanHolder{scan_of(image)}; }), py::arg("image"),
           "A range image; the normals of its points are computed.")
      .def_static(
          "from_points",
          [](const DoubleArray& points, const DoubleArray& origins, const std::optional<FloatArray>& normals,
             const Vec3& axis) { return ScanHolder{scan_of_points(points, origins, normals, axis)}; },
          py::arg("points"), py::arg("origins"), py::arg("normals") = py::none(), py::arg("axis") = Vec3(Vec3::UnitZ()),
          "A sensor without a pinhole: points (n, 3) and the origins of their sight lines (1 or n, 3), metres, sensor "
          "frame; normals (n, 3) facing the sensor; axis (3,) is the viewing direction.")
      .def_property_readonly(
          "image",
          [](const ScanHolder& holder) -> std::optional<RangeImage> {
            const auto* image = std::get_if<ImageScan>(&holder.scan);
            return image == nullptr ? std::nullopt : std::optional(image->image);
          },
          "The RangeImage (a copy), or None for a sensor without a pinhole.")
      .def(
          "points", [](const ScanHolder& holder) { return points_of(holder.scan); },
          "The measured points with their normals, sensor frame: a PointCloud.");

  py::class_<IntegrationReport>(module, "IntegrationReport", "What a scan changed in the map.")
      .def_readonly("points_in_enclosure", &IntegrationReport::points_in_enclosure)
      .def_readonly("new_occupied", &IntegrationReport::new_occupied, "Voxels.");
  constexpr auto* meaning =
      "Updates the labels of the map with a scan from `view` (4x4, world from sensor): voxels of points become "
      "occupied, "
      "those before a point empty, those behind occluded; occplane follows. quality is 'axis' or 'ray'.";
  module.def(
      "integrate",
      [](VoxelMap& map, const ScanHolder& holder, const View& view, const std::string& quality) {
        return integrate_scan(map, holder.scan, view, quality);
      },
      py::arg("map"), py::arg("scan"), py::arg("view"), py::arg("quality") = "axis", meaning);
  module.def("integrate", &integrate_image, py::arg("map"), py::arg("image"), py::arg("view"),
             py::arg("normals") = py::none(), py::arg("quality") = "axis",
             "The same for a RangeImage; normals float32 (rows, columns, 3) are used where they lie, or computed.");
}

}  // namespace vantage::python
