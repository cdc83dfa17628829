/// What the file of a picture says about it.
#pragma once

#include <string>
#include <vector>

namespace hedgerow {

/// A word of 1 to 79 letters, such as "Software", and a text in UTF-8 without zero bytes. PNG keeps notes as
/// texts (iTXt), EXR as attributes in small letters; viewers and `exiftool` list them.
struct Note {
    std::string word, text;
};
using Notes = std::vector<Note>;

}  // namespace hedgerow
