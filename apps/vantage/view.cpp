#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/options/reconstruct_options.hpp"
#include "vantage/report/run_picture.hpp"

namespace vantage::app {
namespace {

struct ViewRequest {
  std::string folder;
  std::string png;
  std::string size = "1200x800";
  RunPicture picture;
};

void view(ViewRequest request) {
  const Resolution size = resolution_from_text("size", request.size);
  request.picture.width = size.columns;
  request.picture.height = size.rows;
  request.picture.validate();
  const StoredRun run = read_stored_run(request.folder);
  const std::filesystem::path file =
      request.png.empty() ? std::filesystem::path(request.folder) / "view.png" : std::filesystem::path(request.png);
  write_file_atomically(file, png_bytes(draw(run, request.picture)));
  fmt::print("{}: {} scans, {} points, {} triangles; picture of the {} written to {}\n", run.object, run.scans.size(),
             run.cloud.size(), run.mesh.triangles.size(), request.picture.show, file.string());
}

}  // namespace

void add_view(CLI::App& program) {
  auto request = std::make_shared<ViewRequest>();
  CLI::App* command = program.add_subcommand("view", "Draw a picture of a run's model and views, without a browser");
  command->add_option("folder", request->folder, "output folder of a run")->required();
  command->add_option("--png", request->png, "file to write; FOLDER/view.png by default");
  std::string subjects;
  for (const std::string& subject : run_picture_subjects()) subjects += (subjects.empty() ? "" : ", ") + subject;
  command->add_option("--show", request->picture.show, subjects)->capture_default_str();
  command->add_option("--size", request->size, "COLUMNSxROWS of the picture")->capture_default_str();
  command->add_option("--turn", request->picture.turn, "look from this far around the object [degrees]")
      ->capture_default_str();
  command->add_option("--rise", request->picture.rise, "look from this far above the horizon [degrees]")
      ->capture_default_str();
  command->callback([request] { view(*request); });
}

}  // namespace vantage::app
