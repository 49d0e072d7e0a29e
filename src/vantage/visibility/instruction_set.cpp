#include "vantage/visibility/instruction_set.hpp"

namespace vantage {

std::string_view name(InstructionSet set) {
  switch (set) {
    case InstructionSet::portable:
      return "portable";
    case InstructionSet::avx2:
      return "AVX2";
    case InstructionSet::avx512:
      return "AVX-512";
  }
  return "unknown";
}

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> sets{InstructionSet::portable};
#ifdef VANTAGE_X86_64
  const bool has_bit_moves = __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (has_bit_moves && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    sets.push_back(InstructionSet::avx2);
  if (has_bit_moves && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

SplatKernels splat_kernels_for(InstructionSet set) {
#ifdef VANTAGE_X86_64
  if (set == InstructionSet::avx2) return splat_kernels_avx2();
  if (set == InstructionSet::avx512) return splat_kernels_avx512();
#endif
  (void)set;
  return splat_kernels_portable();
}

}  // namespace vantage
