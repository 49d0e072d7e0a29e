// The benchmarks of spec, section 12: rows in random order, nine repetitions, medians. Ends with 1 where a row failed,
// for example because its result differs from the reference.
#include <benchmark/benchmark.h>

#include <vector>

namespace {

class FailureCounter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) failures_ += run.error_occurred;
    ConsoleReporter::ReportRuns(runs);
  }
  [[nodiscard]] int failures() const { return failures_; }

 private:
  int failures_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  // Defaults first: what the user gives comes later and wins.
  std::vector<char*> arguments{argv[0]};
  char repetitions[] = "--benchmark_repetitions=9";
  char interleaving[] = "--benchmark_enable_random_interleaving=true";
  char aggregates[] = "--benchmark_display_aggregates_only=true";
  arguments.insert(arguments.end(), {repetitions, interleaving, aggregates});
  arguments.insert(arguments.end(), argv + 1, argv + argc);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  FailureCounter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return reporter.failures() == 0 ? 0 : 1;
}
