#include <fmt/core.h>

#include <memory>

#include "cli_options.hpp"
#include "commands.hpp"
#include "vantage/core/error.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/mesh_writer.hpp"
#include "vantage/formats/octomap_file.hpp"
#include "vantage/model/mesh_quality.hpp"
#include "vantage/runs/run_mesh.hpp"

namespace vantage::app {
namespace {

struct ExportRequest {
  std::string source, out, mesh;
  SurfaceOptions surface;
};

void export_mesh(const ExportRequest& request) {
  const MeasuredMesh mesh = mesh_of_run(request.source, request.surface);
  write_mesh(request.mesh, mesh);
  const MeshQuality quality = quality_of(mesh, request.surface.target_accuracy);
  fmt::print("wrote {}: {} triangles, {:.4g} m^2", request.mesh, quality.triangles,
             quality.seen_area + quality.cap_area);
  if (quality.cap_area > 0)
    fmt::print(", {:.4g} m^2 of it ({:.2f} %) not seen", quality.cap_area, 100 * quality.cap_share());
  if (quality.volume) fmt::print(", {:.6g} m^3", *quality.volume);
  fmt::print("\n");
}

}  // namespace

void add_export(CLI::App& program) {
  auto request = std::make_shared<ExportRequest>();
  CLI::App* command = program.add_subcommand(
      "export", "Write a map (OctoMap .bt) or a run's mesh (.glb, .obj, .stl, .ply) for other programs");
  command
      ->add_option("source", request->source, "map file NAME.nrrd with NAME.ply beside it; for a mesh: a run's folder")
      ->required();
  command->add_option("out", request->out, "file to write the map to, NAME.bt");
  command->add_option("--mesh", request->mesh, "file to write the run's mesh to: NAME.glb, .obj, .stl or .ply");
  for (OptionField& field : option_fields(request->surface)) {
    if (field.name != "target-accuracy") add_option(*command, field);
  }
  command->callback([request] {
    require(request->mesh.empty() != request->out.empty(), "export: give either a file NAME.bt for the map or --mesh");
    if (!request->mesh.empty()) return export_mesh(*request);
    require(request->out.ends_with(".bt"), "out = '", request->out, "': must end in .bt (OctoMap)");
    write_octomap(read_map(request->source), request->out);
    fmt::print("wrote {}\n", request->out);
  });
}

}  // namespace vantage::app
