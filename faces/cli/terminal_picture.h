/// Pictures as text, for terminals that show colours.
#pragma once

#include <string>

#include <hedgerow/io/image.h>

namespace hedgerow::cli {

/// The picture in lines of at most so many characters, each of two pixels, one above the other: means of the
/// picture's pixels there, in 24-bit colours. The picture keeps its shape, and is never enlarged.
std::string terminal_picture(const Image& image, int columns, int rows);

/// The width and height in characters of the terminal at stderr; 80 and 24 where it does not tell.
struct TerminalSize {
    int columns = 80, rows = 24;
};
TerminalSize terminal_size();

}  // namespace hedgerow::cli
