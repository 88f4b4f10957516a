// SPDX-License-Identifier: GPL-3.0-or-later
//
// A BNO055 on an ESP32, by Wi-Fi: a datagram with one line of numbers for each sample, 100 a second.
//
//   wiring   VIN to 3V3, GND to GND, SCL to GPIO 22, SDA to GPIO 21
//   network  enter yours below, and the address of the computer that records
//   record   sparse-mocap record --port udp://0.0.0.0:5005 --driver text_line -o take.csv
//              --option columns=sensor,time,ax,ay,az,gx,gy,gz,qw,qx,qy,qz --option time_unit=us
//              --option angular_velocity_unit=deg/s --site ID=left_wrist
//
// ID is the board's own number, its MAC, which the first line on the serial monitor says. Any number
// of boards may send to the same port.

#include <WiFi.h>
#include <WiFiUdp.h>
#include <Wire.h>

const char* NETWORK = "my network";
const char* PASSWORD = "my password";
const char* COMPUTER = "192.168.1.10";
const uint16_t PORT = 5005;

const uint8_t ADDRESS = 0x28;
const uint32_t PERIOD_US = 10000;

WiFiUDP udp;
String id;

void writeRegister(uint8_t number, uint8_t value) {
  Wire.beginTransmission(ADDRESS);
  Wire.write(number);
  Wire.write(value);
  Wire.endTransmission();
}

// Reads 16-bit numbers, the low byte first, from this register on.
bool readNumbers(uint8_t first, int16_t* values, uint8_t count) {
  Wire.beginTransmission(ADDRESS);
  Wire.write(first);
  Wire.endTransmission(false);
  if (Wire.requestFrom(ADDRESS, (uint8_t)(2 * count)) != 2 * count) return false;
  for (uint8_t i = 0; i < count; i++) {
    const uint8_t low = Wire.read();
    values[i] = (int16_t)(low | (Wire.read() << 8));
  }
  return true;
}

void setup() {
  Serial.begin(115200);
  Wire.begin(21, 22);
  Wire.setClock(400000);
  writeRegister(0x3D, 0x00);  // configuration
  delay(25);
  writeRegister(0x3B, 0x00);  // m/s^2, degrees per second
  writeRegister(0x3D, 0x08);  // accelerometer and gyroscope fused, without the magnetometer
  delay(25);
  WiFi.begin(NETWORK, PASSWORD);
  while (WiFi.status() != WL_CONNECTED) delay(100);
  WiFi.setSleep(false);  // or samples arrive in bursts
  id = WiFi.macAddress();
  Serial.println(id);
}

void loop() {
  static uint32_t next = micros();
  while ((int32_t)((uint32_t)micros() - next) < 0) {
  }
  next += PERIOD_US;
  const unsigned long now = micros();

  int16_t force[3], turn[3], q[4];
  if (!readNumbers(0x08, force, 3) || !readNumbers(0x14, turn, 3) || !readNumbers(0x20, q, 4)) return;

  char line[200];
  snprintf(line, sizeof line, "%s,%lu,%.2f,%.2f,%.2f,%.3f,%.3f,%.3f,%.5f,%.5f,%.5f,%.5f", id.c_str(),
           now, force[0] / 100.0, force[1] / 100.0, force[2] / 100.0, turn[0] / 16.0,
           turn[1] / 16.0, turn[2] / 16.0, q[0] / 16384.0, q[1] / 16384.0, q[2] / 16384.0,
           q[3] / 16384.0);
  udp.beginPacket(COMPUTER, PORT);
  udp.print(line);
  udp.endPacket();
}
