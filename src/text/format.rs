//! Clean text inside other formats, one function each; JSON and tables of TOML are written by their crates.

use super::escape::clean;

/// For the text and the attributes of XML, SVG and HTML.
#[must_use]
pub fn markup(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in clean(text).chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // no characters of XML, in no form
            '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            letter => out.push(letter),
        }
    }
    out
}

/// A comment of XML: it may hold no two hyphens after each other, nor end in one.
#[must_use]
pub fn markup_comment(text: &str) -> String {
    let mut out = String::from("<!-- ");
    for letter in clean(text).chars() {
        if letter == '-' && out.ends_with('-') {
            out.push(' ');
        }
        out.push(if matches!(letter, '\u{fffe}' | '\u{ffff}') { '\u{fffd}' } else { letter });
    }
    out + " -->"
}

/// A comment of one line after `mark`, as shells, Python and TOML have them.
#[must_use]
pub fn line_comment(mark: &str, text: &str) -> String {
    format!("{mark} {}\n", clean(text))
}

/// A string of TOML with its quotes.
#[must_use]
pub fn toml_string(text: &str) -> String {
    toml::Value::String(clean(text)).to_string()
}

/// One word of a command for a POSIX shell: in quotes where a character in it may mean something else to the shell.
#[must_use]
pub fn shell_word(text: &str) -> String {
    let text = clean(text);
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_./:=,@%+".contains(letter);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text;
    }
    format!("'{}'", text.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn markup_means_its_letters() {
        assert_eq!(markup("<a href='x'>\"&\n"), "&lt;a href=&#39;x&#39;&gt;&quot;&amp;\\n");
        assert_eq!(markup_comment("a ---> b-"), "<!-- a - - -> b- -->");
        assert_eq!(line_comment("#", "x\nimport os"), "# x\\nimport os\n");
    }

    #[test]
    fn a_word_of_a_command_is_quoted_where_a_shell_would_read_more_into_it() {
        for plain in ["udpin:0.0.0.0:14550", "serial:/dev/ttyUSB0:57600", "logs/a-b_1.ulg"] {
            assert_eq!(shell_word(plain), plain);
        }
        assert_eq!(shell_word("serial:/dev/my port:57600"), "'serial:/dev/my port:57600'");
        assert_eq!(shell_word("a;rm *"), "'a;rm *'");
        assert_eq!(shell_word("it's"), r"'it'\''s'");
        assert_eq!(shell_word("[::1]:5760"), "'[::1]:5760'");
        assert_eq!(shell_word(""), "''");
    }

    proptest! {
        #[test]
        fn a_string_of_toml_is_read_back(given in any::<String>()) {
            let text = format!("a = {{ b = {} }}\n", toml_string(&given));
            prop_assert_eq!(text.lines().count(), 1, "{}", text);
            let table: toml::Table = toml::from_str(&text).unwrap();
            prop_assert_eq!(table["a"]["b"].as_str().unwrap(), clean(&given));
        }

        #[test]
        fn a_comment_ends_where_it_ends(given in any::<String>()) {
            let comment = markup_comment(&given);
            let inner = comment.strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->")).unwrap();
            prop_assert!(!inner.contains("--") && !comment.contains('\n'));
        }
    }
}
