// The entry points of editing sessions.
#include <beltrami/beltrami.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "abi/buffers.h"
#include "abi/context.h"
#include "abi/core_options.h"
#include "abi/edit_session.h"
#include "abi/reports.h"
#include "atlas/types.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "pack/types.h"
#include "session/ground.h"
#include "session/state.h"

namespace beltrami {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Fault::kInvalidArgument, message);
}

/// The body of a call that edits or asks: body(EditSession&).
template <class Body>
beltrami_status with_session(beltrami_context* context, const Body& body) noexcept {
  return enter(context, [&](beltrami_context& self) {
    body(self.editing());
    return BELTRAMI_OK;
  });
}

beltrami_session describe(const beltrami_context& context, const EditSession& session) {
  const SessionState& state = session.session().state();
  beltrami_session report{};
  Outcome outcome = Outcome::kOk;
  for (const SessionChart& chart : state.charts) {
    if (chart.due != Due::kNothing) ++report.due;
    outcome = std::max(outcome, chart.outcome);
  }
  if (report.due > 0 || !state.toggled.empty()) outcome = std::max(outcome, Outcome::kNotConverged);
  report.status = status_of(outcome);
  report.charts = state.charts.size();
  report.corners = session.corner_count();
  report.changes = session.changes().size();
  report.opened = session.opened().size() / 2;
  report.symmetric_dirichlet = session.session().energy();
  report.seconds = context.session_seconds;
  report.cpu_seconds = context.session_cpu_seconds;
  return report;
}

beltrami_session_chart describe_chart(const EditSession& session, std::uint64_t index) {
  const SessionState& state = session.session().state();
  if (index >= state.charts.size()) {
    refuse("there is no chart " + std::to_string(index) + ": there are " +
           std::to_string(state.charts.size()) + ", counted from 0");
  }
  const SessionChart& chart = state.charts[index];
  const Ground& ground = session.session().ground();
  beltrami_session_chart report{};
  report.status = status_of(chart.outcome);
  report.due = chart.due == Due::kNothing ? 0 : 1;
  report.locked = 1;
  for (Index f = 0; f < chart.faces(); ++f) {
    if (!state.locked[chart.part->chart.input_face[f]]) report.locked = 0;
  }
  report.id = static_cast<std::uint64_t>(chart.id);
  report.triangles = static_cast<std::uint64_t>(chart.faces());
  report.first_face = static_cast<std::uint64_t>(session.face_of(chart.first));
  report.symmetric_dirichlet = chart.energy;
  report.scale = std::ldexp(chart.scale, ground.exponent);
  report.flags = state.flags_of(chart);
  const Index below = state.stacked_on(chart);
  report.stacked_on =
      below == kNone ? UINT64_MAX : static_cast<std::uint64_t>(state.charts[below].id);
  return report;
}

void write_changes(const EditSession& session, void* corners, std::int32_t corner_type, void* uvs,
                   std::int32_t uv_type) {
  const std::vector<Index>& changes = session.changes();
  write_integers(changes, 1, corners, corner_type, 0);
  Writer writer(uvs, uv_type, 0, changes.size(), 2);
  for (std::size_t i = 0; i < changes.size(); ++i) writer.write(i, session.uv(changes[i]).data());
}

}  // namespace
}  // namespace beltrami

using beltrami::EditSession;
using beltrami::enter;
using beltrami::with_session;
using beltrami::Work;

beltrami_status beltrami_session_begin(beltrami_context* context, const beltrami_surface* surface,
                                       beltrami_progress progress, void* user) {
  return enter(context,
               [&](beltrami_context& self) { return self.begin_session(surface, progress, user); });
}

beltrami_status beltrami_session_end(beltrami_context* context) {
  return enter(context, [](beltrami_context& self) {
    self.session.reset();
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_session_set_seams(beltrami_context* context, const beltrami_buffer* edges,
                                           uint64_t count, int32_t open) {
  return with_session(context, [&](EditSession& own) { own.set_seams(edges, count, open != 0); });
}

beltrami_status beltrami_session_set_pins(beltrami_context* context, const beltrami_buffer* corners,
                                          const beltrami_buffer* uvs, uint64_t count) {
  return with_session(context, [&](EditSession& own) { own.set_pins(corners, uvs, count); });
}

beltrami_status beltrami_session_set_pin_kinds(beltrami_context* context,
                                               const beltrami_buffer* kinds,
                                               const beltrami_buffer* directions, uint64_t count) {
  return with_session(context,
                      [&](EditSession& own) { own.set_pin_kinds(kinds, directions, count); });
}

beltrami_status beltrami_session_select(beltrami_context* context, const beltrami_buffer* faces,
                                        uint64_t count) {
  return with_session(context, [&](EditSession& own) { own.select(faces, count); });
}

beltrami_status beltrami_session_lock(beltrami_context* context, const beltrami_buffer* charts,
                                      uint64_t count, int32_t locked) {
  return with_session(context, [&](EditSession& own) { own.lock(charts, count, locked != 0); });
}

beltrami_status beltrami_session_set_flags(beltrami_context* context, const beltrami_buffer* charts,
                                           uint64_t count, uint32_t flags) {
  return with_session(context, [&](EditSession& own) { own.set_flags(charts, count, flags); });
}

beltrami_status beltrami_session_renew(beltrami_context* context, const beltrami_buffer* charts,
                                       uint64_t count, int32_t cold) {
  return with_session(context, [&](EditSession& own) { own.renew(charts, count, cold != 0); });
}

beltrami_status beltrami_session_update(beltrami_context* context, double seconds, int32_t steps,
                                        beltrami_progress progress, void* user) {
  return enter(context, [&](beltrami_context& self) {
    if (!(seconds >= 0)) beltrami::refuse("the seconds are below 0 or no number: give 0 for any");
    if (steps < 0) beltrami::refuse("the steps are below 0: give 0 for as many as it takes");
    return self.run_session(seconds, progress, user, [&](EditSession& own, const Work& work) {
      return beltrami::status_of(own.update(steps, work).outcome);
    });
  });
}

beltrami_status beltrami_session_pack(beltrami_context* context, const beltrami_buffer* charts,
                                      uint64_t count, beltrami_progress progress, void* user) {
  return enter(context, [&](beltrami_context& self) {
    const std::vector<beltrami::Index> ids = EditSession::read_charts(charts, count);
    beltrami::PackOptions options = beltrami::pack_options(self.options);
    options.effort *= beltrami::atlas_options(self.options).effort.packing;
    return self.run_session(0, progress, user, [&](EditSession& own, const Work& work) {
      return beltrami::status_of(own.pack(ids, options, work));
    });
  });
}

beltrami_status beltrami_session_check(beltrami_context* context, beltrami_atlas_certificate* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    return self.run_session(0, nullptr, nullptr, [&](EditSession& own, const Work& work) {
      beltrami_atlas_certificate report = beltrami::describe_atlas(own.check(work));
      beltrami::name_faces(report, [&](beltrami::Index f) {
        const auto& input = own.session().ground().admitted.input_face;
        return static_cast<std::uint64_t>(own.face_of(input[f]));
      });
      beltrami::write_sized(out, report);
      return BELTRAMI_OK;
    });
  });
}

beltrami_status beltrami_session_save(beltrami_context* context, uint64_t* mark) {
  return with_session(context, [&](EditSession& own) {
    if (mark == nullptr) beltrami::refuse("the place for the number is NULL");
    *mark = own.save();
  });
}

beltrami_status beltrami_session_restore(beltrami_context* context, uint64_t mark) {
  return with_session(context, [&](EditSession& own) { own.restore(mark); });
}

beltrami_status beltrami_session_forget(beltrami_context* context, uint64_t mark) {
  return with_session(context, [&](EditSession& own) { own.forget(mark); });
}

beltrami_status beltrami_get_session(beltrami_context* context, beltrami_session* out) {
  return enter(context, [&](beltrami_context& self) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe(self, self.editing()));
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_get_session_chart(beltrami_context* context, uint64_t index,
                                           beltrami_session_chart* out) {
  return with_session(context, [&](const EditSession& own) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe_chart(own, index));
  });
}

beltrami_status beltrami_get_session_uvs(beltrami_context* context, void* out, int32_t type,
                                         uint64_t stride) {
  return with_session(context, [&](const EditSession& own) {
    const std::vector<beltrami::Vec2> uvs = own.uvs();
    beltrami::Writer writer(out, type, stride, uvs.size(), 2);
    for (std::size_t c = 0; c < uvs.size(); ++c) writer.write(c, uvs[c].data());
  });
}

beltrami_status beltrami_get_session_changes(beltrami_context* context, void* corners,
                                             int32_t corner_type, void* uvs, int32_t uv_type) {
  return with_session(context, [&](const EditSession& own) {
    beltrami::write_changes(own, corners, corner_type, uvs, uv_type);
  });
}

beltrami_status beltrami_get_session_face_charts(beltrami_context* context, void* out, int32_t type,
                                                 uint64_t stride) {
  return with_session(context, [&](const EditSession& own) {
    beltrami::write_integers(own.face_charts(), 1, out, type, stride);
  });
}

beltrami_status beltrami_get_session_opened(beltrami_context* context, void* out, int32_t type,
                                            uint64_t stride) {
  return with_session(context, [&](const EditSession& own) {
    beltrami::write_integers(own.opened(), 2, out, type, stride);
  });
}
