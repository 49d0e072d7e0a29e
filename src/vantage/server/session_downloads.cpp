#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/temporary_folder.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/server/session_request.hpp"
#include "vantage/server/session_service.hpp"

namespace vantage {
namespace {

/// What `write` writes to the file that it is given.
template <class Write>
std::shared_ptr<const std::string> written(const std::string& name, const Write& write) {
  const TemporaryFolder folder;
  write(folder.path() / name);
  return std::make_shared<const std::string>(read_file(folder.path() / name));
}

HttpAnswer download(const std::string& name, std::shared_ptr<const std::string> bytes) {
  return {.content_type = "application/octet-stream", .body = std::move(bytes), .file_name = name};
}

void require_scans(const SessionState& state) {
  if (state.scans.empty()) throw HttpError(409, "there is no scan yet; add one");
}

}  // namespace

HttpAnswer SessionService::map_labels(const HttpRequest& request) {
  require_query(request, {});
  const auto state = session_->status().state;
  return download("map.nrrd", written("map.nrrd", [&](const auto& path) { write_map(state->map, path); }));
}

HttpAnswer SessionService::map_surface(const HttpRequest& request) {
  require_query(request, {});
  const auto state = session_->status().state;
  const auto write = [&](const std::filesystem::path& path) { write_map(state->map, path.parent_path() / "map.nrrd"); };
  return download("map.ply", written("map.ply", write));
}

HttpAnswer SessionService::model(const HttpRequest& request) {
  require_query(request, {});
  require_scans(*session_->status().state);
  const PointCloud cloud = session_->cloud();
  return download("model.ply", written("model.ply", [&](const auto& path) { write_cloud_ply(path, cloud); }));
}

HttpAnswer SessionService::mesh(const HttpRequest& request) {
  require_query(request, {});
  const auto state = session_->status().state;
  require_scans(*state);
  // It takes seconds: one at a time, and once for each state.
  const std::lock_guard lock(mesh_mutex_);
  if (meshed_ != state) {
    const MeasuredMesh surface = session_->mesh();
    mesh_ = written("mesh.ply", [&](const auto& path) { write_measured_mesh_ply(path, surface); });
    meshed_ = state;
  }
  return download("mesh.ply", mesh_);
}

}  // namespace vantage
