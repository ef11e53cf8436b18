//! The program's subscriber: messages, log lines, and the log of events of a flight.

use std::fmt;
use std::io;

use clap::ColorChoice;
use mavid::fly::event_layer;
use tracing::field::{Field, Visit};
use tracing::{Event, Metadata, Subscriber};
use tracing_subscriber::filter::{FilterFn, LevelFilter};
use tracing_subscriber::fmt::MakeWriter;
use tracing_subscriber::fmt::format::FmtSpan;
use tracing_subscriber::layer::{Context, Layer, SubscriberExt};
use tracing_subscriber::registry::{LookupSpan, Registry};

use super::color::{Tone, settle};
use super::filter::filter;
use super::handle::StandardError;
use super::target::MESSAGE;
use crate::cli::Verbosity;
use crate::commands::CommandError;

/// Installs the subscriber of the program. A verb that is live talks to vehicles. Where `RUST_LOG` is wrong, what is
/// installed shows the error.
pub fn install(
    verbosity: &Verbosity,
    color: ColorChoice,
    is_live: bool,
) -> Result<StandardError, CommandError> {
    let stderr = StandardError::new(is_live, verbosity.quiet, settle(color))?;
    let filter = filter(verbosity, std::env::var_os("RUST_LOG").as_deref());
    let (log, wrong) = match filter {
        Ok(filter) => (Some(log_lines(stderr.clone()).with_filter(filter)), None),
        Err(error) => (None, Some(error)),
    };
    let subscriber = Registry::default().with(event_layer()).with(messages(stderr.clone())).with(log);
    tracing::subscriber::set_global_default(subscriber)
        .map_err(|error| CommandError::Failure(format!("cannot begin to log: {error}")))?;
    wrong.map_or(Ok(stderr), Err)
}

/// Messages, whatever `RUST_LOG` says; of a quiet stderr errors alone.
fn messages<S>(stderr: StandardError) -> impl Layer<S>
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    let level = if stderr.is_quiet() { LevelFilter::ERROR } else { LevelFilter::INFO };
    let is_shown = move |metadata: &Metadata<'_>| metadata.target() == MESSAGE && *metadata.level() <= level;
    Messages(stderr).with_filter(FilterFn::new(is_shown).with_max_level_hint(level))
}

/// A line for each event, and for the end of each span with the time that it took.
fn log_lines<S>(stderr: StandardError) -> impl Layer<S>
where
    S: Subscriber + for<'a> LookupSpan<'a>,
{
    tracing_subscriber::fmt::layer()
        .with_ansi(false)
        .with_span_events(FmtSpan::CLOSE)
        .with_writer(LogLines(stderr))
        .log_internal_errors(false)
}

/// Writes messages where they are said.
struct Messages(StandardError);

impl<S: Subscriber> Layer<S> for Messages {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let mut text = Text(String::new());
        event.record(&mut text);
        let (prefix, tone) = match *event.metadata().level() {
            tracing::Level::ERROR => ("", Tone::Error),
            tracing::Level::WARN => ("warning: ", Tone::Warning),
            _ => ("", Tone::Plain),
        };
        self.0.message(&format!("{prefix}{}", text.0), tone);
    }
}

/// The text of a message.
struct Text(String);

impl Visit for Text {
    fn record_str(&mut self, field: &Field, value: &str) {
        if field.name() == "message" {
            value.clone_into(&mut self.0);
        }
    }

    /// A message is a string.
    fn record_debug(&mut self, _: &Field, _: &dyn fmt::Debug) {}
}

/// Hands log lines to the stderr.
struct LogLines(StandardError);

impl<'a> MakeWriter<'a> for LogLines {
    type Writer = LogLine<'a>;

    fn make_writer(&'a self) -> Self::Writer {
        LogLine(&self.0)
    }
}

/// Takes one line in one piece, as the formatter gives it.
struct LogLine<'a>(&'a StandardError);

impl io::Write for LogLine<'_> {
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        self.0.log(String::from_utf8_lossy(line).trim_end_matches('\n'));
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
