#include "vantage/runs/stored_run_files.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "support/test_folder.hpp"
#include "vantage/registration/registration.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {
namespace {

ScanRecord read_back(const nlohmann::ordered_json& scan) {
  const nlohmann::ordered_json summary{{"scans", {scan}}};
  return parse_run_summary(summary.dump(), "summary.json").scans.at(0);
}

TEST(StoredRunFiles, WhetherAScanWasMergedIsStoredNotGuessed) {
  ScanRecord record;
  for (const bool merged : {true, false}) {
    record.merged = merged;
    record.verdict = "a word that a later version may choose";
    EXPECT_EQ(read_back(scan_json(record)).merged, merged);
  }
  nlohmann::ordered_json scan = scan_json(record);
  scan["merged"] = "perhaps";
  EXPECT_THAT(input_error_of([&] { (void)read_back(scan); }), testing::HasSubstr("scans[0].merged: must be true"));
}

TEST(StoredRunFiles, SummariesOfEarlierVersionsHaveOnlyTheWord) {
  int refused = 0;
  for (const Verdict verdict :
       {Verdict::registered, Verdict::insufficient_overlap, Verdict::not_converged, Verdict::large_residual,
        Verdict::degenerate, Verdict::in_free_space, Verdict::ambiguous}) {
    ScanRecord record;
    record.verdict = name(verdict);
    nlohmann::ordered_json scan = scan_json(record);
    scan.erase("merged");
    EXPECT_EQ(read_back(scan).merged, verdict == Verdict::registered) << record.verdict;
    refused += verdict == Verdict::registered ? 0 : 1;
  }
  EXPECT_EQ(refused, 6);
}

TEST(StoredRunFiles, OfNewerProgramsAreRefused) {
  EXPECT_TRUE(parse_run_summary(R"({"format": 1, "scans": []})", "summary.json").scans.empty());
  EXPECT_EQ(input_error_of([] { (void)parse_run_summary(R"({"format": 2, "views": []})", "summary.json"); }),
            "summary.json: has format 2; this program knows 1, take the program that wrote it, or a newer one");
  EXPECT_THAT(input_error_of([] { (void)parse_run_summary(R"({"format": "new"})", "summary.json"); }),
              testing::HasSubstr("summary.json, format"));
  EXPECT_THAT(
      input_error_of([] { (void)parse_run_config("# configuration of vantage, format 2\ncamera: x\n", "c.yaml"); }),
      testing::HasSubstr("c.yaml: has format 2"));
}

}  // namespace
}  // namespace vantage
