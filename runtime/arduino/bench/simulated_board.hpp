// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

struct avr_t;
struct avr_irq_t;

/// For tests: an Uno whose processor is simulated, cycle by cycle. Time is the processor's.
namespace rr::serial::testing {

class SimulatedBoard {
 public:
  using Time = std::chrono::microseconds;

  /// Throws std::runtime_error when the program cannot be read.
  SimulatedBoard(const std::string& elf, std::uint32_t baud);
  ~SimulatedBoard();
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;

  /// Puts bytes on the line to the board; they arrive one behind the other.
  void send(const std::vector<std::uint8_t>& bytes);
  /// Runs until then, or until the board has sent a byte.
  void run_until(Time time);
  /// Bytes that have arrived from the board.
  std::vector<std::uint8_t> receive();
  [[nodiscard]] Time now() const;
  /// Whether something is still on the line to the board.
  [[nodiscard]] bool is_sending() const { return !to_board_.empty(); }
  /// As the button does.
  void reset();

  /// Volts on an analog pin.
  void set_voltage(unsigned pin, double volts);
  /// Sets digital pin 0 to 7 from outside.
  void set_pin(unsigned pin, bool is_high);
  /// A byte of the processor's registers.
  [[nodiscard]] std::uint8_t peek(std::uint16_t address) const;

 private:
  static void on_output(avr_irq_t* irq, std::uint32_t value, void* self);
  static void on_ready(avr_irq_t* irq, std::uint32_t value, void* self);
  static void on_full(avr_irq_t* irq, std::uint32_t value, void* self);

  avr_t* avr_ = nullptr;
  std::uint64_t byte_cycles_;
  std::uint64_t next_byte_ = 0;
  bool is_ready_ = true;
  std::deque<std::uint8_t> to_board_;
  std::deque<std::pair<std::uint64_t, std::uint8_t>> from_board_;
};

}  // namespace rr::serial::testing
