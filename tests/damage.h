/// Damages files at random, and reads what comes of it.
#pragma once

#include <functional>
#include <iterator>
#include <random>
#include <string>

#include "io_support.h"

namespace hedgerow::testing_io {

/// A file with one to four damages: a flipped bit, a replaced byte, a cut, a removed piece, an inserted
/// extreme, a repeated piece, or a byte replaced by a digit.
inline std::string damaged(std::string bytes, std::mt19937_64& random) {
    for (std::uint64_t n = 1 + random() % 4; n > 0 && !bytes.empty(); --n) {
        const std::size_t at = random() % bytes.size(), length = 1 + random() % 16;
        const std::string extremes[] = {"-1",
                                        "nan",
                                        "1e999",
                                        "4294967295",
                                        "99999999999999999999",
                                        "-",
                                        "\xFF\xFF\xFF\xFF",
                                        std::string(4, '\0'),
                                        "\n",
                                        " ",
                                        "/",
                                        "\\\n"};
        switch (random() % 7) {
            case 0:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
                break;
            case 1:
                bytes[at] = static_cast<char>(random());
                break;
            case 2:
                bytes.resize(at);
                break;
            case 3:
                bytes.erase(at, length);
                break;
            case 4:
                bytes.insert(at, extremes[random() % std::size(extremes)]);
                break;
            case 5:
                bytes.insert(at, bytes.substr(random() % bytes.size(), length));
                break;
            default:
                bytes[at] = static_cast<char>('0' + random() % 10);
                break;
        }
    }
    return bytes;
}

/// Reads `rounds` damaged versions of a file. Returns how many could still be read; the others must throw an
/// InputError that names the file.
template <class F>
int survivors(const TempFolder& folder, const std::string& name, const std::string& whole, int rounds,
              F read) {
    std::mt19937_64 random(std::hash<int>()(static_cast<int>(whole.size())));
    int read_well = 0;
    for (int i = 0; i < rounds; ++i) {
        const auto path = folder.file(name, damaged(whole, random));
        try {
            read(path);
            ++read_well;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
        }
    }
    return read_well;
}

}  // namespace hedgerow::testing_io
