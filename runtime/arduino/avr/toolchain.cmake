# SPDX-License-Identifier: Apache-2.0
# An Uno: ATmega328P at 16 MHz, as the Arduino IDE compiles for it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_C_COMPILER avr-gcc)
set(CMAKE_CXX_COMPILER avr-g++)
# Archives with code for the linker's optimizer need the compiler's own tools.
set(CMAKE_AR avr-gcc-ar CACHE FILEPATH "")
set(CMAKE_RANLIB avr-gcc-ranlib CACHE FILEPATH "")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# The core asks for DECIMAL_DIG, which this compiler's headers do not have in C++11.
set(board_flags "-mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10819 -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR -DDECIMAL_DIG=__DECIMAL_DIG__")
set(CMAKE_C_FLAGS_INIT "${board_flags} -Os -std=gnu11 -ffunction-sections -fdata-sections -flto -fno-fat-lto-objects")
set(CMAKE_CXX_FLAGS_INIT "${board_flags} -Os -std=gnu++11 -fno-exceptions -ffunction-sections -fdata-sections -fno-threadsafe-statics -flto -fno-fat-lto-objects")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-mmcu=atmega328p -Os -flto -fuse-linker-plugin -Wl,--gc-sections")
