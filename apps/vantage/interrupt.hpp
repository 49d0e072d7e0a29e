#pragma once

namespace vantage::app {

/// From now on the first Ctrl-C (SIGINT) or SIGTERM only sets a flag that a long job asks for between two steps; the
/// second one ends the program at once.
void catch_interrupts();
[[nodiscard]] bool was_interrupted();

}  // namespace vantage::app
