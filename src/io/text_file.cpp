#include <hedgerow/io/text_file.h>

#include "output_file.h"

namespace hedgerow {

void save_text(const std::filesystem::path& path, std::string_view text) {
    detail::OutputFile file(path);
    file.write(text);
    file.commit();
}

}  // namespace hedgerow
