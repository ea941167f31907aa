/// The destination of the frames of a sequence: numbered files, or a film.
#pragma once

#include <memory>

#include "render/render.h"
#include "viewer/options.h"

namespace plab::view
{

class FrameSink
{
public:
    virtual ~FrameSink() = default;
    virtual Result<void> add(std::uint64_t index, const render::Picture& picture) = 0;
    /// No more frames follow. A sink that is not finished leaves no partial film behind.
    virtual Result<void> finish() = 0;
};

/// For Task::Frames and Task::Film: makes the folder, or starts ffmpeg.
Result<std::unique_ptr<FrameSink>> open_frame_sink(const ViewerOptions& options);

}  // namespace plab::view
