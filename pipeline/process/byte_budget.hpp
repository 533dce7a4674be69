#pragma once

#include <cstddef>
#include <utility>

namespace houghstream {

/// Counts the bytes that the items of one queue, or of several, hold in total. Each item keeps the Reservation that
/// reserve() returned for it: however an item leaves, popped, dropped or replaced, its bytes are released with that. It
/// only counts; the queue decides which item is dropped where there are too many. Not thread-safe: reservations are
/// moved and destroyed under the queue's lock as well. It must outlive its reservations, and so is declared before the
/// items.
class ByteBudget {
 public:
  /// The bytes of one item, which count as long as this object lives.
  class Reservation {
   public:
    Reservation() = default;
    ~Reservation() {
      if (budget_ != nullptr) budget_->total_ -= bytes_;
    }
    Reservation(Reservation&& other) noexcept : budget_(std::exchange(other.budget_, nullptr)), bytes_(other.bytes_) {}
    Reservation& operator=(Reservation&& other) noexcept {
      Reservation moved(std::move(other));
      std::swap(budget_, moved.budget_);
      std::swap(bytes_, moved.bytes_);
      return *this;
    }
    Reservation(const Reservation&) = delete;
    Reservation& operator=(const Reservation&) = delete;

    /// Zero where nothing is held: by default, and after a move.
    std::size_t bytes() const { return budget_ == nullptr ? 0 : bytes_; }

   private:
    friend class ByteBudget;
    Reservation(ByteBudget& budget, std::size_t bytes) : budget_(&budget), bytes_(bytes) { budget.total_ += bytes; }

    ByteBudget* budget_ = nullptr;
    std::size_t bytes_ = 0;
  };

  ByteBudget() = default;
  ByteBudget(const ByteBudget&) = delete;
  ByteBudget& operator=(const ByteBudget&) = delete;

  [[nodiscard]] Reservation reserve(std::size_t bytes) { return {*this, bytes}; }
  std::size_t total() const { return total_; }

 private:
  std::size_t total_ = 0;
};

}  // namespace houghstream
