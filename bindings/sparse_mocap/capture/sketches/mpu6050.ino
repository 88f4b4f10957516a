// SPDX-License-Identifier: GPL-3.0-or-later
//
// An MPU6050 on an Arduino, by USB: one line of numbers for each sample, 100 a second.
//
//   wiring   VCC to 5V (3V3 on 3.3 V boards), GND to GND, SCL and SDA to the board's SCL and SDA
//   record   sparse-mocap record --port PORT --driver text_line --baud 115200 -o take.csv
//              --option columns=time,ax,ay,az,gx,gy,gz --option time_unit=us
//              --option acceleration_unit=raw --option counts_per_g=4096
//              --option angular_velocity_unit=raw --option counts_per_degps=16.4
//
// The accelerometer's range is 8 g and the gyroscope's 2000 degrees per second: wrists need both.

#include <Wire.h>

const uint8_t ADDRESS = 0x68;
const uint32_t PERIOD_US = 10000;

void writeRegister(uint8_t number, uint8_t value) {
  Wire.beginTransmission(ADDRESS);
  Wire.write(number);
  Wire.write(value);
  Wire.endTransmission();
}

int16_t readNumber() {
  const uint8_t high = Wire.read();
  return (int16_t)((high << 8) | (uint8_t)Wire.read());
}

void setup() {
  Serial.begin(115200);
  Wire.begin();
  Wire.setClock(400000);
  writeRegister(0x6B, 0);     // wake up
  writeRegister(0x1A, 3);     // low-pass at 44 Hz
  writeRegister(0x1B, 0x18);  // 2000 degrees per second
  writeRegister(0x1C, 0x10);  // 8 g
}

void loop() {
  static uint32_t next = micros();
  while ((int32_t)((uint32_t)micros() - next) < 0) {
  }
  next += PERIOD_US;
  const unsigned long now = micros();

  Wire.beginTransmission(ADDRESS);
  Wire.write(0x3B);
  Wire.endTransmission(false);
  if (Wire.requestFrom(ADDRESS, (uint8_t)14) != 14) return;  // not connected

  int16_t values[7];
  for (int i = 0; i < 7; i++) values[i] = readNumber();  // ax ay az temperature gx gy gz

  Serial.print(now);
  for (int i = 0; i < 7; i++) {
    if (i == 3) continue;
    Serial.print(',');
    Serial.print(values[i]);
  }
  Serial.println();
}
