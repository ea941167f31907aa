#include <nlohmann/json.hpp>

#include "idl/samples.h"
#include "link/catalogue.h"
#include "link/frame_reader.h"
#include "link/json.h"
#include "link/sequence.h"
#include "python/native/guard.h"
#include "python/native/handles.h"

struct PlabCatalogue
{
    plab::link::Catalogue catalogue;
    std::string text;
};

struct PlabFrames
{
    const plab::link::Session* session = nullptr;
    plab::link::FrameReader reader;
    std::deque<plab::python::KeptFrame> waiting;  ///< what came with the last look
    std::vector<plab::python::KeptFrame> spare;   ///< memory
};

struct PlabEntries
{
    virtual ~PlabEntries() = default;
    virtual bool wait(plab::link::Seconds slice) = 0;
    virtual void take() = 0;
    virtual unsigned writers() const = 0;

    std::deque<std::string> waiting;
    std::string text;
    std::uint64_t missing = 0;
};

namespace
{

using namespace plab;
using python::guarded;

// ---- Catalogues -------------------------------------------------------------------------------------------------------------------------

template <class Things>
link::Json list_of(const Things& things)
{
    link::Json out = link::Json::array();
    for (const auto& [id, thing] : things) out.push_back(link::json_of(thing));
    return out;
}

link::Json scene_of(const link::Scene& scene)
{
    return {{"server", scene.server_name}, {"run", scene.run}, {"file", scene.file},
            {"title", scene.title},        {"dt", scene.dt},   {"seed", scene.seed}};
}

template <class T>
link::Json value_or_null(const std::optional<T>& value)
{
    return value ? link::json_of(*value) : link::Json();
}

link::Json part_of(const link::CatalogueContents& now, link::Part part)
{
    switch (part)
    {
        case link::Part::Server:
            return value_or_null(now.server);
        case link::Part::Scene:
            return now.scene ? scene_of(*now.scene) : link::Json();
        case link::Part::Objects:
            return list_of(now.objects);
        case link::Part::Shapes:
            return list_of(now.shapes);
        case link::Part::Interactions:
            return list_of(now.interactions);
        case link::Part::Types:
            return list_of(now.types);
        case link::Part::Metrics:
            return value_or_null(now.metrics);
    }
    return {};
}

Result<PlabCatalogue*> open_catalogue(const PlabSession& session, unsigned parts)
{
    auto catalogue = link::Catalogue::open(session.session, parts);
    if (!catalogue) return catalogue.errors();
    return new PlabCatalogue{catalogue.take(), {}};
}

Result<int> fetch(PlabCatalogue& catalogue, double slice)
{
    const auto fetched = catalogue.catalogue.fetch(link::Seconds(slice));
    if (!fetched) python::set_error(fetched.errors());
    return fetched ? 1 : 0;
}

// ---- Frames -----------------------------------------------------------------------------------------------------------------------------

Result<PlabFrames*> open_frames(const PlabSession& session)
{
    auto reader = link::FrameReader::open(session.session);
    if (!reader) return reader.errors();
    return new PlabFrames{&session.session, reader.take(), {}, {}};
}

void take_frames(PlabFrames& frames)
{
    (void)frames.reader.take(
        [&](const plab_v2_Frame& frame)
        {
            frames.waiting.emplace_back();
            if (!frames.spare.empty()) frames.waiting.back() = std::move(frames.spare.back()), frames.spare.pop_back();
            frames.waiting.back().keep(frame);
        });
}

/// The one that was handed out last stays at the front of `waiting` until the next call.
Result<int> next_frame(PlabFrames& frames, double slice, PlabFrame& out)
{
    if (!frames.waiting.empty())
    {
        frames.spare.push_back(std::move(frames.waiting.front()));
        frames.waiting.pop_front();
    }
    if (frames.waiting.empty() && frames.session->wait(frames.reader, link::Seconds(slice))) take_frames(frames);
    if (frames.waiting.empty()) return 0;
    const python::KeptFrame& front = frames.waiting.front();
    out = python::view_of(front.head, front.bodies.data(), front.bodies.size(), front.shafts.data(), front.shafts.size());
    return 1;
}

// ---- Events, collisions and contacts ----------------------------------------------------------------------------------------------------

/// What of a sample is an entry: one of its entries each, of contacts the whole sample.
template <class T>
void add_texts(const T& sample, std::deque<std::string>& to)
{
    for (std::uint32_t i = 0; i < sample.entries._length; ++i) to.push_back(link::line_of(link::json_of(sample, i)));
}
void add_texts(const plab_v2_ContactForces& sample, std::deque<std::string>& to)
{
    to.assign(1, link::line_of(link::json_of(wire::value_of<wire::ContactForces>(sample))));  // the newest
}

/// How many entries did not arrive before this sample. Of contacts the newest are delivered, and none is missing.
template <class T>
std::uint64_t missing_before(const T& sample, dds_instance_handle_t writer, link::Sequence& sequence)
{
    return sequence.note(writer, sample.sequence_number, sample.entries._length).count;
}
std::uint64_t missing_before(const plab_v2_ContactForces&, dds_instance_handle_t, link::Sequence&) { return 0; }

template <class T>
struct EntriesOf final : PlabEntries
{
    const link::Session* session = nullptr;
    wire::DataReader<T> reader;
    link::Sequence sequence;

    bool wait(link::Seconds slice) override { return session->wait(reader, slice); }
    unsigned writers() const override { return reader.writers(); }
    void take() override
    {
        (void)reader.take(
            [&](const T& sample, const dds_sample_info_t& info)
            {
                if (!info.valid_data) return;
                missing += missing_before(sample, info.publication_handle, sequence);
                add_texts(sample, waiting);
            },
            1);
    }
};

template <class T>
Result<PlabEntries*> open_entries(const PlabSession& session)
{
    auto reader = session.session.reader<T>();
    if (!reader) return reader.errors();
    auto out = std::make_unique<EntriesOf<T>>();
    out->session = &session.session, out->reader = reader.take();
    return out.release();
}

Result<PlabEntries*> open_entries(const PlabSession& session, const std::string& topic)
{
    if (topic == wire::topic_of<plab_v2_Events>().name) return open_entries<plab_v2_Events>(session);
    if (topic == wire::topic_of<plab_v2_Collisions>().name) return open_entries<plab_v2_Collisions>(session);
    if (topic == wire::topic_of<plab_v2_ContactForces>().name) return open_entries<plab_v2_ContactForces>(session);
    return reason("'" + topic + "' has no entries");
}

Result<const char*> next_entry(PlabEntries& entries, double slice)
{
    if (entries.waiting.empty() && entries.wait(link::Seconds(slice))) entries.take();
    entries.text.clear();
    if (!entries.waiting.empty()) entries.text = std::move(entries.waiting.front()), entries.waiting.pop_front();
    return entries.text.c_str();
}

}  // namespace

PlabCatalogue* plab_catalogue_open(PlabSession* session, unsigned parts)
{
    return guarded([&] { return open_catalogue(*session, parts); });
}

int plab_catalogue_fetch(PlabCatalogue* catalogue, double slice)
{
    return guarded([&] { return fetch(*catalogue, slice); });
}

const char* plab_catalogue_text(PlabCatalogue* catalogue, unsigned part)
{
    return guarded(
        [&]() -> Result<const char*>
        {
            catalogue->text = link::line_of(part_of(catalogue->catalogue.now(), static_cast<link::Part>(part)));
            return catalogue->text.c_str();
        });
}

const char* plab_catalogue_names(PlabCatalogue* catalogue)
{
    return guarded(
        [&]() -> Result<const char*>
        {
            link::Json out = link::Json::array();
            for (const auto& [id, object] : catalogue->catalogue.now().objects) out.push_back({object.run, object.handle, id});
            catalogue->text = link::line_of(out);
            return catalogue->text.c_str();
        });
}

void plab_catalogue_close(PlabCatalogue* catalogue) { delete catalogue; }

PlabFrames* plab_frames_open(PlabSession* session)
{
    return guarded([&] { return open_frames(*session); });
}

int plab_frames_next(PlabFrames* frames, double slice, PlabFrame* out)
{
    return guarded([&] { return next_frame(*frames, slice, *out); });
}

unsigned plab_frames_writers(PlabFrames* frames) { return frames->reader.writers(); }

void plab_frames_close(PlabFrames* frames) { delete frames; }

PlabEntries* plab_entries_open(PlabSession* session, const char* topic)
{
    return guarded([&] { return open_entries(*session, std::string(topic)); });
}

const char* plab_entries_next(PlabEntries* entries, double slice)
{
    return guarded([&] { return next_entry(*entries, slice); });
}

std::uint64_t plab_entries_missing(PlabEntries* entries) { return entries->missing; }

unsigned plab_entries_writers(PlabEntries* entries) { return entries->writers(); }

void plab_entries_close(PlabEntries* entries) { delete entries; }
