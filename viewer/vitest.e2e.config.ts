import { defineConfig } from "vitest/config";

// One browser at a time: software rendering already takes all processors.
export default defineConfig({
  test: { include: ["e2e/**/*.e2e.ts"], testTimeout: 400_000, hookTimeout: 400_000, fileParallelism: false },
});
