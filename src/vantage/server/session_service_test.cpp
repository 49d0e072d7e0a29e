#include "vantage/server/session_service.hpp"

#include <gmock/gmock.h>
#include <httplib.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "support/test_folder.hpp"
#include "vantage/formats/png16.hpp"

namespace vantage {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

ScanPlanningOptions small_options() {
  ScanPlanningOptions options;
  options.scene.box = Eigen::Matrix<double, 6, 1>{{0.0, 0.0, 0.0, 1.0, 1.0, 1.0}};
  options.scene.voxel = 0.1;
  options.scene.views = 20;
  options.scene.registration = "none";
  options.reading.depth_range = {0.1, 4.5};
  options.reading.no_return = 65535;
  return options;
}

std::string part(const std::string& name, const std::string& body) {
  return "--B\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\n" + body + "\r\n";
}

/// A square plate of 0.4 m across the middle of the box, seen from 2 m above by 40x40 pixels, as a form.
std::string plate_form(const std::string& pose = "1 0 0 0\n0 -1 0 0\n0 0 -1 2\n0 0 0 1\n") {
  Gray16 image{{40, 40}, std::vector<std::uint16_t>(1600, 65535)};
  for (std::size_t row = 14; row < 26; ++row)
    for (std::size_t column = 14; column < 26; ++column) image.values[40 * row + column] = 2000;
  return part("depth", encode_png16(image)) + part("pose", pose) + part("intrinsics", "50 0 19.5\n0 50 19.5\n0 0 1\n") +
         "--B--\r\n";
}

/// A session of this folder and a client of its server.
struct ServedSession {
  LiveRun run;
  SessionService service;
  HttpServer server{{}};
  std::unique_ptr<httplib::Client> client;

  explicit ServedSession(const std::filesystem::path& folder) : service(folder, run) {
    add_page(server, run);
    service.add_routes(server);
    server.start();
    client = std::make_unique<httplib::Client>("127.0.0.1", server.port());
    client->set_read_timeout(60);
  }

  httplib::Result get(const std::string& path) { return client->Get("/api/session" + path); }
  httplib::Result post(const std::string& path, const std::string& body, const char* type = "application/json") {
    return client->Post("/api/session" + path, body, type);
  }
  httplib::Result add(const std::string& form, const std::string& query = "") {
    return post("/scans" + query, form, "multipart/form-data; boundary=B");
  }
  Json status() { return Json::parse(get("")->body); }
  Json next() { return Json::parse(get("/next")->body); }
};

std::string error_in(const httplib::Result& result) { return Json::parse(result->body).at("error"); }

struct SessionServiceTest : testing::Test {
  TestFolder folder;
  void SetUp() override { Session::create(folder / "s", small_options()); }
};

TEST_F(SessionServiceTest, TakesScansAndSaysWhereToLook) {
  ServedSession s(folder / "s");
  EXPECT_EQ(s.status()["stored"], 0);
  EXPECT_EQ(s.next()["next"], nullptr);
  EXPECT_EQ(s.next()["explanation"], "there is no scan yet; add one");
  EXPECT_EQ(s.post("/next", "{}")->status, 409);
  const auto added = s.add(plate_form());
  ASSERT_EQ(added->status, 201) << added->body;
  EXPECT_EQ(Json::parse(added->body)["number"], 0);
  EXPECT_TRUE(Json::parse(added->body)["merged"]);
  EXPECT_GT(Json::parse(added->body)["occupied"], 0);
  EXPECT_EQ(s.add(plate_form(), "?wait=no")->status, 202);
  const Json next = s.next();
  EXPECT_EQ(next["next"]["index"], next["ranking"][0]["index"]);
  EXPECT_THAT(s.get("/map.nrrd")->body, testing::StartsWith("NRRD"));
  for (const char* file : {"/map.ply", "/model.ply", "/mesh.ply"})
    EXPECT_THAT(s.get(file)->body, testing::StartsWith("ply")) << file;
}

TEST_F(SessionServiceTest, AScanThatIsSentAgainWithItsKeyIsAnsweredAndNotStoredTwice) {
  const std::string form = part("key", "7") + plate_form();
  {
    ServedSession s(folder / "s");
    const auto first = s.add(form), again = s.add(form);
    EXPECT_EQ(first->status, 201);
    EXPECT_EQ(again->status, 201);
    EXPECT_EQ(first->body, again->body);
  }
  ServedSession s(folder / "s");
  EXPECT_EQ(Json::parse(s.add(form)->body)["number"], 0);
  EXPECT_EQ(Json::parse(s.add(plate_form())->body)["number"], 1);
  EXPECT_EQ(s.status()["stored"], 2);
}

TEST_F(SessionServiceTest, AViewIsTakenSkippedAndPlannedAgain) {
  ServedSession s(folder / "s");
  (void)s.add(plate_form());
  const Json ranking = s.next()["ranking"];
  const int best = ranking[0]["index"], second = ranking[1]["index"];
  EXPECT_EQ(Json::parse(s.post("/next", "")->body)["index"], best);
  EXPECT_EQ(s.status()["taken"]["candidate"], best);
  EXPECT_EQ(Json::parse(s.post("/next", Json{{"candidate", second}}.dump())->body)["pose"], ranking[1]["pose"]);
  EXPECT_EQ(Json::parse(*s.run.document())["take"]["candidate"], second);
  // A scan from elsewhere is not the one of the view that somebody goes to.
  EXPECT_TRUE(Json::parse(s.add(plate_form())->body)["candidate"].is_null());
  EXPECT_EQ(s.status()["taken"]["candidate"], second);
  const Json there = Json::parse(s.add(part("candidate", std::to_string(second)) + plate_form())->body);
  EXPECT_EQ(there["commanded"], ranking[1]["pose"]);
  EXPECT_EQ(there["candidate"], second);
  EXPECT_EQ(s.status()["taken"], nullptr);
  EXPECT_EQ(s.post("/skip", Json{{"candidate", best}, {"reason", "a cable"}}.dump())->status, 200);
  EXPECT_EQ(s.status()["skipped"], Json::array({{{"index", best}, {"reason", "a cable"}}}));
  const auto refused = s.post("/next", Json{{"candidate", best}}.dump());
  EXPECT_EQ(refused->status, 409);
  EXPECT_THAT(error_in(refused), HasSubstr("a cable"));
  EXPECT_EQ(s.post("/unskip", Json{{"candidate", best}}.dump())->status, 200);
  EXPECT_THAT(s.status()["skipped"], testing::IsEmpty());
}

TEST_F(SessionServiceTest, RefusesWhatIsNotAsDescribed) {
  ServedSession s(folder / "s");
  (void)s.add(plate_form());
  int cases = 0;
  for (const auto& [path, body, text] : {std::tuple{"/skip", "{\"candidate\": 20, \"reason\": \"x\"}", "0 .. 19"},
                                         {"/skip", "{\"candidate\": 1}", "reason: must be text"},
                                         {"/skip", "{\"candidate\": \"1\", \"reason\": \"x\"}", "is string"},
                                         {"/skip", "{\"reason\": \"x\"}", "has no 'candidate'"},
                                         {"/skip", "[]", "must be an object, is array"},
                                         {"/skip", "{\"candidate\": 1, \"why\": \"x\"}", "key 'why' is not known"},
                                         {"/unskip", "{\"candidate\": 1}", "was not skipped"},
                                         {"/next", "{\"candidate\": -1}", "candidate = -1"},
                                         {"/finish", "{\"all\": true}", "key 'all' is not known; there is none"},
                                         {"/finish", "{", "body"}}) {
    const auto answer = s.post(path, body);
    EXPECT_EQ(answer->status, 400) << path << body;
    EXPECT_THAT(error_in(answer), HasSubstr(text)) << path << body;
    ++cases;
  }
  EXPECT_EQ(cases, 10);
  for (const char* query : {"/next?top=-1", "/next?top=1e3", "/next?tpo=3", "?x=1", "/map.nrrd?x=1"})
    EXPECT_EQ(s.get(query)->status, 400) << query;
  EXPECT_THAT(error_in(s.add(plate_form(), "?wait=perhaps")), HasSubstr("wait = 'perhaps': must be yes or no"));
  EXPECT_THAT(error_in(s.add(plate_form("1 2 3"))), HasSubstr("pose"));
  EXPECT_THAT(error_in(s.add(plate_form("1 0 0 1e9\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"))), HasSubstr("from the origin"));
  EXPECT_EQ(s.status()["stored"], 1);
}

TEST_F(SessionServiceTest, SaysWhatWasDroppedWithoutNamingFoldersOfTheHost) {
  {
    ServedSession s(folder / "s");
    for (int i = 0; i < 2; ++i) (void)s.add(plate_form());
  }
  std::ofstream(folder / "s" / "session" / "000001.scan") << "damaged";
  ServedSession s(folder / "s");
  const Json status = s.status();
  EXPECT_EQ(status["stored"], 1);
  EXPECT_THAT(status["dropped"][0].get<std::string>(), HasSubstr("left out scan 1, kept as s/session/000001.damaged"));
  EXPECT_THAT(status.dump(), testing::Not(HasSubstr((folder / "s").parent_path().string())));
  const auto later = s.add(plate_form());
  EXPECT_EQ(later->status, 201);
  EXPECT_EQ(Json::parse(later->body)["number"], 2);
}

TEST_F(SessionServiceTest, FinishWritesTheFolderAndScansMayFollow) {
  ServedSession s(folder / "s");
  EXPECT_EQ(s.post("/finish", "{}")->status, 409);
  (void)s.add(plate_form());
  const auto finished = s.post("/finish", "{}");
  ASSERT_EQ(finished->status, 200) << finished->body;
  EXPECT_EQ(Json::parse(finished->body)["views"], 1);
  for (const char* file : {"map.nrrd", "model.ply", "summary.json", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder / "s" / file)) << file;
  EXPECT_EQ(Json::parse(*s.run.document())["meta"]["state"], "finished");
  EXPECT_EQ(s.add(plate_form())->status, 201);
  EXPECT_EQ(Json::parse(*s.run.document())["meta"]["state"], "waiting");
  EXPECT_EQ(Json::parse(*s.run.document())["scans"].size(), 2U);
}

TEST_F(SessionServiceTest, ThePageShowsThePlanOnTheLastScan) {
  ServedSession s(folder / "s");
  const Json before = Json::parse(*s.run.document());
  EXPECT_EQ(before["meta"]["state"], "waiting");
  EXPECT_THAT(before["scans"], testing::IsEmpty());
  LiveRun::Reader reader;
  (void)s.run.next(reader, std::chrono::seconds(1));
  (void)s.add(plate_form());
  std::string heard;
  while (heard.find("event: plan") == std::string::npos) heard += *s.run.next(reader, std::chrono::seconds(60));
  EXPECT_LT(heard.find("event: setup"), heard.find("event: scan"));
  const Json document = Json::parse(*s.run.document());
  EXPECT_EQ(document["next"]["chosen"], s.next()["next"]["index"]);
  EXPECT_EQ(document["candidates"]["poses"]["shape"], Json::array({20, 7}));
}

TEST_F(SessionServiceTest, AFrameMuchLargerThanThoseOfTheSessionIsRefused) {
  ServedSession s(folder / "s");
  ASSERT_EQ(s.add(plate_form())->status, 201);
  const Gray16 larger{{81, 80}, std::vector<std::uint16_t>(6480, 1000)};
  const std::string form = part("depth", encode_png16(larger)) + part("pose", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n") +
                           part("intrinsics", "50 0 40\n0 50 40\n0 0 1\n") + "--B--\r\n";
  const auto refused = s.add(form);
  EXPECT_EQ(refused->status, 400);
  EXPECT_THAT(error_in(refused), HasSubstr("depth: has 81x80 pixels; must have at most 6400"));
}

TEST_F(SessionServiceTest, NoAnswerNamesAFolderOfTheMachine) {
  ScanPlanningOptions options = small_options();
  std::ofstream(folder / "camera.txt") << "50 0 19.5\n0 50 19.5\n0 0 1\n";
  options.reading.intrinsics = (folder / "camera.txt").string();
  Session::create(folder / "other", options);
  ServedSession s(folder / "other");
  (void)s.add(plate_form());
  std::filesystem::create_directory(folder / "other" / "map.nrrd");
  const auto failed = s.post("/finish", "{}");
  EXPECT_EQ(failed->status, 500);
  for (const std::string& text : {failed->body, s.get("")->body, *s.run.document()})
    EXPECT_THAT(text, testing::Not(HasSubstr(folder.path().string())));
  EXPECT_THAT(*s.run.document(), HasSubstr("camera.txt"));
}

}  // namespace
}  // namespace vantage
