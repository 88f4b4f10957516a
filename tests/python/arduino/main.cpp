// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a sketch for COUNT samples; REGISTER=VALUE... are bytes that the sensor measures.
#include <cstdlib>

#include "Arduino.h"

void setup();
void loop();

int main(int count, char** arguments) {
  for (int i = 2; i < count; ++i) {
    const std::string pair(arguments[i]);
    const auto equals = pair.find('=');
    Wire.registers[std::stoi(pair.substr(0, equals))] =
        static_cast<uint8_t>(std::stoi(pair.substr(equals + 1)));
  }
  setup();
  for (int i = 0; i < std::atoi(arguments[1]); ++i) loop();
  return 0;
}
