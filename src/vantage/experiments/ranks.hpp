#pragma once

#include <optional>
#include <string>

namespace vantage {

/// The processes that work on one sweep together, rank 0 first. The sweep knows no more of MPI than this.
class Ranks {
 public:
  struct Message {
    int from = 0;
    std::string bytes;
  };

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// Messages from one rank to another arrive in the order in which they were sent. Called from one thread only.
  virtual void send(int to, const std::string& bytes) = 0;
  /// The next message, if there is one; does not wait.
  [[nodiscard]] virtual std::optional<Message> receive() = 0;
  /// Ends all processes, this one too, where there are others that would wait for this one for ever.
  virtual void give_up() = 0;
};

/// One process alone.
class SingleRank : public Ranks {
 public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int size() const override { return 1; }
  void send(int, const std::string&) override {}
  [[nodiscard]] std::optional<Message> receive() override { return std::nullopt; }
  void give_up() override {}
};

}  // namespace vantage
