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

}  // namespace
}  // namespace vantage
