#include "bindings.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/map/integrate.hpp"
#include "vantage/map/scan.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage::python {
namespace {

SceneOptions scene(const Vec3& center, double voxel_length, const Index3& scene_size, const Index3& enclosure_size) {
  SceneOptions options{center, voxel_length, scene_size, enclosure_size};
  options.validate();
  return options;
}

/// The labels of the enclosure, x fastest in memory.
py::array_t<std::uint8_t> labels(const VoxelMap& map) {
  const IndexBox& box = map.enclosure();
  const Index3 size = box.size();
  std::vector<std::uint8_t> values;
  values.reserve(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
                 static_cast<std::size_t>(size.z()));
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        values.push_back(static_cast<std::uint8_t>(map.label({x, y, z})));
      }
    }
  }
  return array_of<std::uint8_t>(std::move(values), {size.z(), size.y(), size.x()}).attr("transpose")();
}

void set_labels(VoxelMap& map, const py::array_t<std::uint8_t>& values) {
  const IndexBox& box = map.enclosure();
  const Index3 size = box.size();
  require_shape(values, {size.x(), size.y(), size.z()}, "labels (x, y, z of the enclosure)");
  const auto at = values.unchecked<3>();
  for (int z = 0; z < size.z(); ++z) {
    for (int y = 0; y < size.y(); ++y) {
      for (int x = 0; x < size.x(); ++x) {
        const std::uint8_t label = at(x, y, z);
        require(label < all_labels.size(), "labels[", x, ", ", y, ", ", z, "] = ", int{label}, ": must be 0 to 4");
        map.set_label(box.min + Index3(x, y, z), static_cast<Label>(label));
      }
    }
  }
}

/// What the occupied voxels know of the surface in them.
py::dict surface(const VoxelMap& map) {
  std::vector<Index3> voxels = map.occupied_voxels();
  std::vector<Vec3> centers, normals;
  std::vector<double> quality;
  for (const Index3& voxel : voxels) {
    const SurfaceVoxel* found = map.surface(voxel);
    centers.push_back(map.grid().center(voxel));
    normals.push_back(found->normal());
    quality.push_back(found->quality);
  }
  py::dict result;
  const auto count = static_cast<py::ssize_t>(voxels.size());
  result["voxels"] = rows_of(std::move(voxels));
  result["centers"] = rows_of(std::move(centers));
  result["normals"] = rows_of(std::move(normals));
  result["quality"] = array_of<double>(std::move(quality), {count});
  return result;
}

void bind_voxel_map(py::module_& module) {
  py::class_<VoxelMap>(module, "VoxelMap",
                       "The scene with five labels per voxel. Only the enclosure is stored; everything outside it is "
                       "empty for ever. Not to be changed while another thread uses it.")
      .def(py::init<const SceneOptions&>(), py::arg("scene"), "All of the enclosure is unmarked.")
      .def(py::init<const VoxelMap&>(), py::arg("map"), "A copy.")
      .def_static("read", &read_map, py::arg("path"), "From NAME.nrrd and the NAME.ply beside it.")
      .def(
          "write", [](const VoxelMap& map, const std::filesystem::path& path) { write_map(map, path); },
          py::arg("path"), "To NAME.nrrd (labels) and NAME.ply beside it (occupied voxels with normal and quality).")
      .def_property_readonly(
          "voxel_length", [](const VoxelMap& map) { return map.grid().length; }, "Metres.")
      .def_property_readonly(
          "origin", [](const VoxelMap& map) { return map.grid().box(map.enclosure()).min(); },
          "The corner of the enclosure's first voxel: (3,), metres. Voxel [i, j, k] of labels() covers origin + "
          "voxel_length * [i, j, k] to one voxel further.")
      .def_property_readonly(
          "box", [](const VoxelMap& map) { return map.grid().box(map.enclosure()); },
          "The enclosure's least and greatest corner: (2, 3), metres.")
      .def_property_readonly(
          "enclosure", [](const VoxelMap& map) { return std::pair(map.enclosure().min, map.enclosure().max); },
          "The first and the last voxel of the enclosure in scene indices, both (3,) int32.")
      .def_property_readonly(
          "scene_size", [](const VoxelMap& map) { return map.grid().size; }, "Voxels of the scene: (3,) int32.")
      .def("labels", &labels,
           "Labels of the enclosure: uint8 (nx, ny, nz), indexed [x, y, z], x fastest in memory; the numbers are those "
           "of "
           "Label. A copy: the map itself packs its labels into bits.")
      .def("set_labels", &set_labels, py::arg("labels"),
           "Replaces all labels of the enclosure: uint8 (nx, ny, nz). Voxels that are newly occupied have no normal.")
      .def(
          "surface", &surface,
          "The occupied voxels, x fastest: a dict of voxels (n, 3) int32 scene indices, centers (n, 3) metres, normals "
          "(n, 3) unit vectors or zero, quality (n,) cosines.")
      .def("count", &VoxelMap::count, py::arg("label"), "Voxels of the whole scene with this label.")
      .def("mean_quality", &VoxelMap::mean_quality, "Mean over all occupied voxels, in [0, 1]; 0 where there are none.")
      .def("__eq__",
           [](const VoxelMap& a, const VoxelMap& b) {
             return a.grid().min == b.grid().min && a.grid().length == b.grid().length &&
                    a.grid().size == b.grid().size && a.enclosure().min == b.enclosure().min &&
                    a.enclosure().max == b.enclosure().max && a.occupied().words == b.occupied().words &&
                    a.empty().words == b.empty().words && a.hidden().words == b.hidden().words &&
                    a.occplane().words == b.occplane().words;
           })
      .def("__repr__", [](const VoxelMap& map) {
        const Index3 size = map.enclosure().size();
        std::string text = concat("<vantage.VoxelMap ", size.x(), "x", size.y(), "x", size.z(), " voxels of ",
                                  map.grid().length, " m");
        for (const Label label : {Label::unmarked, Label::occupied, Label::occluded, Label::occplane}) {
          text += concat(", ", map.count(label), " ", name(label));
        }
        return text + ">";
      });
}

void bind_visibility(py::module_& module) {
  py::class_<Visibility>(module, "Visibility", "What a view would see: numbers of distinct voxels that end a ray.")
      .def_readonly("rays", &Visibility::rays)
      .def_readonly("occupied", &Visibility::occupied, "n_oc of the paper.")
      .def_readonly("occplane", &Visibility::occplane, "n_op of the paper.")
      .def_readonly("unmarked", &Visibility::unmarked, "n_um of the paper.")
      .def_readonly("occluded", &Visibility::occluded, "Occluded but not occplane; they count in nothing.")
      .def("__eq__", [](const Visibility& a, const Visibility& b) { return a == b; })
      .def("__repr__", [](const Visibility& seen) {
        return concat("<vantage.Visibility occupied ", seen.occupied, ", occplane ", seen.occplane, ", unmarked ",
                      seen.unmarked, ", occluded ", seen.occluded, " by ", seen.rays, " rays>");
      });
  using Release = py::call_guard<py::gil_scoped_release>;
  py::class_<VisibilityEvaluator>(
      module, "VisibilityEvaluator",
      "What many views would see of one state of a map, prepared once. Make a new one after "
      "the map has changed. Exact: the voxels are those that rays would meet.")
      .def(py::init<const VoxelMap&>(), py::arg("map"), py::keep_alive<1, 2>(), Release())
      .def("see", py::overload_cast<const RangeCamera&, const View&, Resolution>(&VisibilityEvaluator::see, py::const_),
           py::arg("camera"), py::arg("view"), py::arg("resolution"), Release(),
           "What the camera would see from a view (4x4, world from sensor) with rays of that resolution (columns, "
           "rows).")
      .def(
          "see_all",
          [](const VisibilityEvaluator& evaluator, const RangeCamera& camera, const std::vector<View>& views,
             Resolution resolution) {
            return evaluator.see(camera, views, std::span<const Resolution>(&resolution, 1));
          },
          py::arg("camera"), py::arg("views"), py::arg("resolution"), Release(),
          "The same for many views, (N, 4, 4), in parallel; the same for any number of threads.")
      .def(
          "visible_voxels",
          [](const VisibilityEvaluator& evaluator, const RangeCamera& camera, const View& view, Resolution resolution) {
            std::vector<Index3> voxels;
            {
              const py::gil_scoped_release release;
              voxels = evaluator.visible_voxels(camera, view, resolution);
            }
            return rows_of(std::move(voxels));
          },
          py::arg("camera"), py::arg("view"), py::arg("resolution"),
          "The voxels that are counted: (n, 3) int32 scene indices, x fastest.");
  module.def("see_exactly", &see_exactly, py::arg("map"), py::arg("camera"), py::arg("view"), py::arg("resolution"),
             Release(), "The slow definition of VisibilityEvaluator.see: one exact ray after the other.");
}

}  // namespace

void bind_map(py::module_& module) {
  py::enum_<Label> label(module, "Label", "What is known of a voxel; the numbers are those of labels() and map files.");
  for (const Label each : all_labels) label.value(std::string(name(each)).c_str(), each);
  py::class_<SceneOptions>(module, "SceneOptions", "The voxels of a scene and the object's enclosure in its middle.")
      .def(py::init(&scene), py::arg("center") = Vec3(Vec3::Zero()), py::arg("voxel_length") = 0.02,
           py::arg("scene_size") = Index3(Index3::Constant(205)),
           py::arg("enclosure_size") = Index3(Index3::Constant(55)),
           "center (3,) and voxel_length in metres, sizes (3,) in voxels.")
      .def_readonly("center", &SceneOptions::center, "(3,), metres.")
      .def_readonly("voxel_length", &SceneOptions::voxel_length, "Metres.")
      .def_readonly("scene_size", &SceneOptions::scene_size, "(3,) int32, voxels.")
      .def_readonly("enclosure_size", &SceneOptions::enclosure_size, "(3,) int32, voxels.");
  bind_voxel_map(module);
  bind_visibility(module);
}

}  // namespace vantage::python
