// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace sparse_mocap::testing {

// Expects a call to throw an Error whose message contains the text.
template <class Error, class Call>
void expect_refusal(const char* file, int line, std::string_view text, const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.find(text) == std::string::npos)
      ADD_FAILURE_AT(file, line) << "\"" << text << "\" is not in the message: " << message;
    return;
  }
  ADD_FAILURE_AT(file, line) << "nothing was thrown";
}

}  // namespace sparse_mocap::testing

// EXPECT_REFUSED(Error, "text", expression): the expression throws an Error that says the text.
#define EXPECT_REFUSED(Error, text, ...)                                   \
  ::sparse_mocap::testing::expect_refusal<Error>(__FILE__, __LINE__, text, \
                                                 [&] { static_cast<void>(__VA_ARGS__); })
