/// The state of a picture by paths, from which `render --resume` goes on.
#pragma once

#include <future>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/render/integrators/path_picture.h>

#include "render_looks.h"

namespace hedgerow::cli {

/// The file of a state. Without a name there is none: nothing is loaded, and nothing must be saved.
class SavedPicture {
public:
    /// For pictures of a scene by these options: all that their light depends on, but for the number of
    /// samples.
    template <class T>
    SavedPicture(const RenderArguments& a, const ShownModel<T>& shown, const PathPictureOptions& options);

    bool has_file() const { return !file_.empty(); }
    /// The picture that work goes on from: that of the file, if it exists. If that has no direct light, the
    /// options no longer ask for it, and a warning says so. Throws as load_state does.
    PathPicture begun(const RenderArguments& a, PathPictureOptions& options) const;
    /// Saves the picture's work, after the copy that was begun. Throws as save_state does, for the copy too.
    void save(const PathPicture& picture);
    /// Begins to save a copy of the picture's work on another thread, after the copy before. The call takes a
    /// twentieth of the time of `save`. Throws as save_state does, for the copy before.
    void begin_to_save(const PathPicture& picture);

private:
    PathPicture load(int width, int height) const;
    void finish_copy();
    void write(const PathPicture& picture) const;

    std::string file_;
    std::vector<std::pair<std::string, std::string>> of_;  // names and values of all that light depends on
    int halves_;                                           // that have samples
    PathPicture copy_{1, 1};
    std::future<void> saving_;  // its destructor waits
};
extern template SavedPicture::SavedPicture(const RenderArguments&, const ShownModel<float>&,
                                           const PathPictureOptions&);
extern template SavedPicture::SavedPicture(const RenderArguments&, const ShownModel<double>&,
                                           const PathPictureOptions&);

}  // namespace hedgerow::cli
