/// What a file can keep of notes.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/io/notes.h>

namespace hedgerow::detail {

inline void check_notes(const std::filesystem::path& path, const Notes& notes) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    for (std::size_t i = 0; i < notes.size(); ++i) {
        const Note& note = notes[i];
        const std::string place = path.string() + ": note " + std::to_string(i + 1);
        if (note.word.empty() || note.word.size() > 79 || !std::ranges::all_of(note.word, is_letter))
            throw InputError(place + " has the word \"" + note.word + "\": a word has 1 to 79 letters");
        if (note.text.find('\0') != std::string::npos)
            throw InputError(place + " (" + note.word + ") has a zero byte in its text. Leave it out");
    }
}

}  // namespace hedgerow::detail
