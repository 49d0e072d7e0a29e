#include "mpi_ranks.hpp"

#ifdef VANTAGE_MPI

#include <mpi.h>

#include <list>

#include "vantage/core/error.hpp"

namespace vantage::app {
namespace {

constexpr int tag = 1;

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    require(provided >= MPI_THREAD_FUNNELED, "MPI: does not allow threads beside the one that sends messages");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  ~MpiRanks() override {
    for (Sending& each : sending_) MPI_Wait(&each.request, MPI_STATUS_IGNORE);
    MPI_Finalize();
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }

  void send(int to, const std::string& bytes) override {
    std::erase_if(sending_, [](Sending& each) {
      int done = 0;
      MPI_Test(&each.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
    // Not waiting for the receiver keeps two ranks that send to each other from waiting for ever.
    Sending& mine = sending_.emplace_back(bytes);
    MPI_Isend(mine.bytes.data(), static_cast<int>(mine.bytes.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD, &mine.request);
  }

  [[nodiscard]] std::optional<Message> receive() override {
    int waiting = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &waiting, &status);
    if (waiting == 0) return std::nullopt;
    int count = 0;
    MPI_Get_count(&status, MPI_CHAR, &count);
    Message message{status.MPI_SOURCE, std::string(static_cast<std::size_t>(count), '\0')};
    MPI_Recv(message.bytes.data(), count, MPI_CHAR, status.MPI_SOURCE, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }

  void give_up() override { MPI_Abort(MPI_COMM_WORLD, 1); }

 private:
  struct Sending {
    explicit Sending(std::string text) : bytes(std::move(text)) {}
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  int rank_ = 0, size_ = 1;
  std::list<Sending> sending_;
};

}  // namespace

std::unique_ptr<Ranks> make_mpi_ranks() { return std::make_unique<MpiRanks>(); }

}  // namespace vantage::app

#endif
