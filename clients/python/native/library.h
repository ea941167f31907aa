/// What the Python package calls through ctypes: clients/link and idl/recording behind functions of C. Only plab/_native.py uses it: it is
/// installed beside that file, and both change together.
///
/// A function returns null or a negative number where it failed, and plab_error() has the reason, of the same thread. Texts and arrays
/// belong to what returned them and are valid until its next call; texts are UTF-8. Waits take seconds, return early when what is waited
/// for has come, and are meant to be short: a caller that has to notice Ctrl-C waits in slices. What a function is given must not be used
/// by another thread at the same time, and all that was opened of a session is closed before the session.
#pragma once

#include <cstddef>
#include <cstdint>

#define PLAB_PYTHON_API extern "C" __attribute__((visibility("default")))

struct PlabSession;
struct PlabCatalogue;
struct PlabFrames;
struct PlabEntries;
struct PlabRecording;

struct PlabNamedText
{
    const char* name;
    const char* text;
};

struct PlabOperation
{
    const char* verb;
    const char* target;
    const char* argument;
    const char* blueprint;
    const PlabNamedText* values;
    std::size_t value_count;
};

/// A complete frame. A row of `bodies` has 14 doubles: the handle in the first 4 bytes of the first; position x y z (m), orientation w x y
/// z (X_WB), linear velocity x y z (m/s), angular velocity x y z (rad/s), as in plab.idl. A row of `shafts` has 3: the handle likewise;
/// angle (rad), speed (rad/s).
struct PlabFrame
{
    std::uint64_t run;
    std::uint64_t revision;
    std::uint64_t number;  ///< sequence_number: a jump is frames that did not arrive
    std::int64_t step;
    double time;            ///< s, simulated
    std::int64_t stamp_ns;  ///< since 1970, when the step ended
    const double* bodies;
    std::size_t body_count;
    const double* shafts;
    std::size_t shaft_count;
};

/// A message of a recording: a frame or JSON.
struct PlabMessage
{
    const char* topic;
    double time;       ///< s, of the recording's own time line
    const char* text;  ///< JSON, a list if the topic's messages have entries; null: it is a frame
    PlabFrame frame;
};

/// Of pLab: "0.2.0".
PLAB_PYTHON_API const char* plab_version();
/// Why the last call of this thread failed; "" if it did not.
PLAB_PYTHON_API const char* plab_error();

// ---- Sessions and requests --------------------------------------------------------------------------------------------------------------

/// Joins a domain. `server`: a name, or "" for the only server; `domain` < 0 and null for the others: PLAB_DOMAIN, PLAB_INTERFACE,
/// PLAB_SERVER.
PLAB_PYTHON_API PlabSession* plab_join(const char* server, int domain, const char* network_interface);
/// Looks for the server: 1 it is there, 0 not yet (plab_error() lists what is), -1 it cannot be chosen.
PLAB_PYTHON_API int plab_find(PlabSession* session, double slice);
/// Gets ready for requests: 1, 0 not yet.
PLAB_PYTHON_API int plab_connect(PlabSession* session, double slice);
PLAB_PYTHON_API const char* plab_server(PlabSession* session);
/// JSON: a list of the domain's servers.
PLAB_PYTHON_API const char* plab_servers(PlabSession* session, double seconds);
/// Sends a request; it takes the place of one that waits for its reply. `at`, `revision`: -1 for any. After plab_connect().
PLAB_PYTHON_API int plab_request(PlabSession* session, const PlabOperation* operations, std::size_t count, std::int64_t at,
                                 std::int64_t revision);
/// JSON: its reply; "" not yet; null: the server has gone.
PLAB_PYTHON_API const char* plab_reply(PlabSession* session, double slice);
/// The name of the last request, for the operation `cancel`.
PLAB_PYTHON_API const char* plab_last_request(PlabSession* session);
PLAB_PYTHON_API void plab_leave(PlabSession* session);

// ---- What a server says -----------------------------------------------------------------------------------------------------------------

/// `parts`: link::Part. The contents come with plab_catalogue_fetch(): 1 complete, 0 not yet (plab_error() states what is missing).
PLAB_PYTHON_API PlabCatalogue* plab_catalogue_open(PlabSession* session, unsigned parts);
PLAB_PYTHON_API int plab_catalogue_fetch(PlabCatalogue* catalogue, double slice);
/// JSON of one part as it stands: a list, or of the server, the scene and the metrics an object or null.
PLAB_PYTHON_API const char* plab_catalogue_text(PlabCatalogue* catalogue, unsigned part);
/// JSON: a list of [run, handle, id] of all objects, in a twentieth of the time that their whole text takes.
PLAB_PYTHON_API const char* plab_catalogue_names(PlabCatalogue* catalogue);
PLAB_PYTHON_API void plab_catalogue_close(PlabCatalogue* catalogue);

PLAB_PYTHON_API PlabFrames* plab_frames_open(PlabSession* session);
/// 1: the next frame; 0: none within the slice.
PLAB_PYTHON_API int plab_frames_next(PlabFrames* frames, double slice, PlabFrame* out);
/// 0: the server has gone, or was not found yet.
PLAB_PYTHON_API unsigned plab_frames_writers(PlabFrames* frames);
PLAB_PYTHON_API void plab_frames_close(PlabFrames* frames);

/// Entries of plab/events or plab/collisions, or samples of plab/contacts.
PLAB_PYTHON_API PlabEntries* plab_entries_open(PlabSession* session, const char* topic);
/// JSON of the next entry; "" none within the slice.
PLAB_PYTHON_API const char* plab_entries_next(PlabEntries* entries, double slice);
/// Entries that did not arrive, so far.
PLAB_PYTHON_API std::uint64_t plab_entries_missing(PlabEntries* entries);
PLAB_PYTHON_API unsigned plab_entries_writers(PlabEntries* entries);
PLAB_PYTHON_API void plab_entries_close(PlabEntries* entries);

// ---- Recordings -------------------------------------------------------------------------------------------------------------------------

PLAB_PYTHON_API PlabRecording* plab_recording_open(const char* path);
/// JSON: what the file says of its origin (server, scene_file, dt ...), all as text.
PLAB_PYTHON_API const char* plab_recording_about(PlabRecording* recording);
/// Begins to read messages of these topics, from and to these seconds, inclusive.
PLAB_PYTHON_API int plab_recording_select(PlabRecording* recording, const char* const* topics, std::size_t count, double from, double to);
/// 1: a message; 0: the end; -1: something is damaged, and the next call goes on behind it.
PLAB_PYTHON_API int plab_recording_next(PlabRecording* recording, PlabMessage* out);
PLAB_PYTHON_API void plab_recording_close(PlabRecording* recording);
