// SPDX-License-Identifier: Apache-2.0
// simulated_board PROGRAM.elf [VOLTS]: a board at a port whose path is printed, with so many volts
// at A0, until standard input ends.
#include <cstdlib>
#include <exception>
#include <iostream>

#include "runtime/arduino/bench/light/stay.hpp"
#include "runtime/arduino/bench/plugged_board.hpp"

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: simulated_board PROGRAM.elf [VOLTS]\n";
    return 2;
  }
  try {
    rr::serial::testing::PluggedBoard board(argv[1]);
    if (argc == 3) board.set_voltage(std::atof(argv[2]));
    std::cout << "port " << board.path() << std::endl;
    rr::serial::testing::stay();
  } catch (const std::exception& error) {
    std::cerr << "simulated_board: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
