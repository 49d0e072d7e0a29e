#pragma once

#include <string_view>
#include <vector>

#include "vantage/visibility/splat_batch.hpp"

namespace vantage {

/// The instructions that the vectorised path is compiled for. The results are the same for all.
enum class InstructionSet { portable, avx2, avx512 };

[[nodiscard]] std::string_view name(InstructionSet set);
/// Those that this program was built for and this processor runs, the fastest last.
[[nodiscard]] std::vector<InstructionSet> available_instruction_sets();
[[nodiscard]] SplatKernels splat_kernels_for(InstructionSet set);

}  // namespace vantage
