/// Numbers as text, and text from the bus made safe to show on a terminal.
#pragma once

#include <string>
#include <string_view>

#include "plab/number_text.h"

namespace plab::link
{

/// The shortest decimal text that reads back as `value`: "0.1", "inf", "nan".
using plab::number_text;
std::string number_text(float value);

/// Control characters are written as "\x1b" and the like, so that foreign text cannot control the terminal. Bytes that are not valid
/// UTF-8 become U+FFFD.
std::string terminal_text(std::string_view text);

}  // namespace plab::link
