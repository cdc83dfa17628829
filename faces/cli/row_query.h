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

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/columns.h>

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

/// Answers rows by lists. `ask(given, found)` writes the list of one, and `list(item, record)` the columns of
/// an item.
template <class Given, class Item, std::floating_point T, class Ask, class List>
void answer_by_lists(const RowOptions& options, const T* numbers, std::uint64_t first, std::size_t count,
                     AnsweredRows& answers, Ask ask, List list) {
    const std::size_t columns = RowsOf<Given>::columns().size();
    std::vector<Item> found;
    for (std::size_t i = 0; i < count; ++i) {
        const T* const row = numbers + i * columns;
        if (!RowsOf<Given>::usable(row)) {
            answers.refuse(first + i);
            continue;
        }
        ask(RowsOf<Given>::of(row, options), found);
        for (const auto& item : found)
            append_record(answers.records, [&](Record& record) {
                record("query", first + i);
                list(item, record);
            });
        answers.rows += found.size();
    }
}
/// Answers rows by one row each. `ask_all(given, found)` answers them together; `list(answer, record)` writes
/// the columns of an answer, which is `none` where a row can have none.
template <class Given, class Answer, std::floating_point T, class AskAll, class List>
void answer_by_rows(const RowOptions& options, const T* numbers, std::uint64_t first, std::size_t count,
                    AnsweredRows& answers, const Answer& none, AskAll ask_all, List list) {
    const std::size_t columns = RowsOf<Given>::columns().size();
    const auto row = [&](std::size_t i) { return numbers + i * columns; };
    // The thread keeps this memory for its next rows.
    static thread_local std::vector<Given> given;
    static thread_local std::unique_ptr<Answer[]> found;
    if (given.size() < count) found.reset(new Answer[count]);
    given.resize(std::max(given.size(), count));
    for (std::size_t i = 0; i < count; ++i) given[i] = RowsOf<Given>::of(row(i), options);
    ask_all(std::span<const Given>(given.data(), count), std::span<Answer>(found.get(), count));
    RecordSize size;
    list(none, size);
    append_records(answers.records, count, size.bytes, [&](std::size_t i, Record& record) {
        const bool usable = RowsOf<Given>::usable(row(i));
        if (!usable) answers.refuse(first + i);
        list(usable ? found[i] : none, record);
    });
    answers.rows = count;
}

}  // namespace hedgerow::cli
