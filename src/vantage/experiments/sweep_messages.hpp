#pragma once

#include <span>
#include <string>

#include "vantage/experiments/local_workers.hpp"

namespace vantage {

/// What ranks of a sweep tell each other, as JSON texts.
struct SweepMessage {
  enum class Kind {
    want,    // to rank 0: a thread has nothing to do; `text` is the digest of the list of runs
    run,     // from rank 0: work on this run
    stop,    // from rank 0: no more runs will come
    result,  // to rank 0: what came of a run
    bye      // to rank 0: the last message of a rank
  };
  Kind kind = Kind::want;
  std::size_t run = 0;
  RunResult result;
  std::string text;
};

[[nodiscard]] std::string encode(const SweepMessage& message);
/// Throws Error for anything that encode() does not write.
[[nodiscard]] SweepMessage decode(const std::string& bytes);

/// A digest that ranks with other lists of runs do not share.
[[nodiscard]] std::string digest_of(std::span<const SweepRun> runs);

}  // namespace vantage
