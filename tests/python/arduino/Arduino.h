// SPDX-License-Identifier: GPL-3.0-or-later
// As much of Arduino as the sketches use, to run them on this machine: what they print or send goes
// to stdout, and the sensor on the wire always reads the same registers.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>

using String = std::string;

inline unsigned long micros() {
  static unsigned long now = 4294960000ul;  // wraps soon
  now += 50;
  return now & 0xFFFFFFFFul;
}
inline void delay(unsigned long) {}

struct Printer {
  void begin(long) {}
  void print(char text) { std::putchar(text); }
  void print(int number) { std::printf("%d", number); }
  void print(unsigned long number) { std::printf("%lu", number); }
  void println() { std::printf("\r\n"); }
  void println(const String& text) { std::fprintf(stderr, "%s\n", text.c_str()); }
};
inline Printer Serial;

struct TwoWire {
  std::map<int, uint8_t> registers;  // what the sensor measures
  int at = 0, num_written = 0;

  void begin(int = 0, int = 0) {}
  void setClock(long) {}
  void beginTransmission(uint8_t) { num_written = 0; }
  void write(uint8_t value) {
    if (num_written++ == 0) at = value;
  }
  void endTransmission(bool = true) {}
  int requestFrom(uint8_t, uint8_t count) { return count; }
  uint8_t read() { return registers[at++]; }
};
inline TwoWire Wire;

constexpr int WL_CONNECTED = 3;
struct Network {
  void begin(const char*, const char*) {}
  int status() { return WL_CONNECTED; }
  void setSleep(bool) {}
  String macAddress() { return "24:6F:28:AA:BB:CC"; }
};
inline Network WiFi;

struct WiFiUDP {
  void beginPacket(const char*, uint16_t) {}
  void print(const char* text) { std::printf("%s\n", text); }
  void endPacket() {}
};
