// SPDX-License-Identifier: Apache-2.0
#include "runtime/arduino/bench/simulated_board.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

extern "C" {
#include <simavr/avr_adc.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

// The simulator never frees what it reads a program into, nor its own tables.
// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libsimavr\n"; }
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

namespace rr::serial::testing {
namespace {

constexpr std::uint64_t frequency = 16'000'000;
constexpr std::uint64_t cycles_of_microsecond = frequency / 1'000'000;

// The simulator would print what it loads to standard output, which is for others.
void report(avr_t* /*avr*/, const int level, const char* format, va_list arguments) {
  if (level <= LOG_ERROR) std::vfprintf(stderr, format, arguments);
}

}  // namespace

SimulatedBoard::SimulatedBoard(const std::string& elf, std::uint32_t baud)
    : byte_cycles_(10 * frequency / baud) {
  avr_global_logger_set(&report);
  elf_firmware_t firmware{};
  if (elf_read_firmware(elf.c_str(), &firmware) != 0) {
    throw std::runtime_error(elf + " cannot be read");
  }
  avr_ = avr_make_mcu_by_name("atmega328p");
  if (avr_ == nullptr) throw std::runtime_error("no such processor");
  avr_init(avr_);
  avr_->frequency = frequency;
  avr_->log = LOG_ERROR;
  avr_->vcc = avr_->avcc = avr_->aref = 5000;
  avr_load_firmware(avr_, &firmware);
  // A program that sleeps or polls must not make this one sleep.
  avr_->sleep = [](avr_t*, avr_cycle_count_t) {};
  std::uint32_t flags = 0;
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  const auto irq = [this](int which) {
    return avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), which);
  };
  avr_irq_register_notify(irq(UART_IRQ_OUTPUT), &SimulatedBoard::on_output, this);
  avr_irq_register_notify(irq(UART_IRQ_OUT_XON), &SimulatedBoard::on_ready, this);
  avr_irq_register_notify(irq(UART_IRQ_OUT_XOFF), &SimulatedBoard::on_full, this);
}

SimulatedBoard::~SimulatedBoard() {
  avr_terminate(avr_);
  free(avr_);
}

void SimulatedBoard::on_output(avr_irq_t*, std::uint32_t value, void* self) {
  SimulatedBoard& board = *static_cast<SimulatedBoard*>(self);
  // It is there when its last bit is.
  board.from_board_.emplace_back(board.avr_->cycle + board.byte_cycles_,
                                 static_cast<std::uint8_t>(value));
}
void SimulatedBoard::on_ready(avr_irq_t*, std::uint32_t, void* self) {
  static_cast<SimulatedBoard*>(self)->is_ready_ = true;
}
void SimulatedBoard::on_full(avr_irq_t*, std::uint32_t, void* self) {
  static_cast<SimulatedBoard*>(self)->is_ready_ = false;
}

void SimulatedBoard::send(const std::vector<std::uint8_t>& bytes) {
  if (to_board_.empty()) next_byte_ = std::max(next_byte_, avr_->cycle + byte_cycles_);
  to_board_.insert(to_board_.end(), bytes.begin(), bytes.end());
}

void SimulatedBoard::run_until(Time time) {
  const std::uint64_t end = static_cast<std::uint64_t>(time.count()) * cycles_of_microsecond;
  while (avr_->cycle < end) {
    if (!from_board_.empty() && from_board_.front().first <= avr_->cycle) return;
    if (!to_board_.empty() && avr_->cycle >= next_byte_) {
      // A processor that does not keep up loses bytes; the simulator would keep them.
      if (is_ready_) {
        avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT),
                      to_board_.front());
      }
      to_board_.pop_front();
      next_byte_ += byte_cycles_;
    }
    avr_run(avr_);
  }
}

std::vector<std::uint8_t> SimulatedBoard::receive() {
  std::vector<std::uint8_t> bytes;
  while (!from_board_.empty() && from_board_.front().first <= avr_->cycle) {
    bytes.push_back(from_board_.front().second);
    from_board_.pop_front();
  }
  return bytes;
}

SimulatedBoard::Time SimulatedBoard::now() const {
  return Time(static_cast<std::int64_t>(avr_->cycle / cycles_of_microsecond));
}

void SimulatedBoard::reset() {
  const avr_cycle_count_t cycle = avr_->cycle;
  avr_reset(avr_);
  avr_->cycle = cycle;
}

void SimulatedBoard::set_voltage(unsigned pin, double volts) {
  avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + static_cast<int>(pin)),
                static_cast<std::uint32_t>(volts * 1000));
}

void SimulatedBoard::set_pin(unsigned pin, bool is_high) {
  avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('D'), static_cast<int>(pin)),
                is_high ? 1 : 0);
}

std::uint8_t SimulatedBoard::peek(std::uint16_t address) const { return avr_->data[address]; }

}  // namespace rr::serial::testing
