#include "commands.hpp"
namespace vantage::app {
void add_evaluate(CLI::App&) {}
}  // namespace vantage::app
