#pragma once

#include <gmock/gmock.h>

/// Expects that a call throws Error with `text` in its message: the field, its value and the bound that it breaks.
#define EXPECT_REFUSED(call, Error, text) \
  EXPECT_THAT([&] { static_cast<void>(call); }, ::testing::ThrowsMessage<Error>(::testing::HasSubstr(text)))
