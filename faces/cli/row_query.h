/// What the queries of rows share: from the file of rows to the report.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <hedgerow/any_question.h>
#include <hedgerow/base/error.h>

#include "query.h"
#include "row_stream.h"
#include "verbs.h"

namespace hedgerow::cli {

/// Ends the file after `run` has written its rows. Where it ended early, those that it wrote are kept under
/// the name of unfinished work.
template <class F>
void write_rows(const QueryArguments& a, RowWriter& out, QueryReport& report, F run) {
    const auto keep = [&] {
        report.finished = false;
        report.answered = out.rows();
        if (report.answered == 0 && a.output != "-") return;
        report.output = a.output == "-" ? a.output : unfinished_name(a.output);
        out.finish_as(report.output);
    };
    try {
        run();
        out.finish();
        report.output = a.output, report.answered = out.rows();
    } catch (const Cancelled&) {
        keep();
    } catch (const InputError& e) {
        keep();
        if (report.output.empty() || a.output == "-") throw;
        throw InputError(fmt::format("{}. The answers to rows before it are in {}", e.what(), report.output));
    }
}

/// Rows that are read, and those that answer them. The answer to a row is one row, or else a list of them.
struct RowPlan {
    std::size_t columns_read;
    std::vector<Column> written;
    bool lists;
};

/// Answers all rows of `in`, and prints the report. Returns the exit code.
template <std::floating_point T>
int answer_all(const QueryArguments& a, RowReader<T>& in, const RowPlan& plan,
               typename RowStream<T>::Answer answer, QueryReport report) {
    std::optional<std::uint64_t> rows;
    if (!plan.lists) rows = in.size();
    RowWriter out(a.output, row_format(a.output, a.output_format), plan.written, rows);
    RowStream<T> stream(in, plan.columns_read, out, default_executor(),
                        plan.lists ? cut_for_lists : cut_for_batches);
    const double start = now();
    write_rows(a, out, report, [&] {
        ProgressLine line("answering " + a.kind, a.quiet, "rows");
        stream.run(answer, line.progress());
    });
    report.seconds = now() - start;
    report.asked = stream.asked();
    report.unusable = stream.unusable(), report.first_unusable = stream.first_unusable();
    return print_report(a, report);
}

}  // namespace hedgerow::cli
