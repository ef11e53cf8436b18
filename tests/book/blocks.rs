//! Generated blocks in pages that are written by hand.

/// The page with each block's text between its markers, `<!-- generated: NAME -->` and `<!-- end of NAME -->`.
pub fn replaced(page: &str, blocks: &[(&str, String)]) -> Result<String, String> {
    let mut text = page.to_owned();
    for (name, block) in blocks {
        let (opening, closing) = (format!("<!-- generated: {name} -->\n"), format!("<!-- end of {name} -->"));
        let from = text.find(&opening).ok_or_else(|| format!("expected a line `{}`", opening.trim_end()))?;
        let from = from + opening.len();
        let length = text[from..].find(&closing).ok_or_else(|| format!("expected a line `{closing}`"))?;
        text.replace_range(from..from + length, &format!("\n{}\n\n", block.trim_end()));
    }
    Ok(text)
}

/// Lines of at most this many characters.
const WIDTH: usize = 120;

/// A paragraph broken into lines; code in backticks may be broken at its spaces, as Markdown allows.
pub fn paragraph(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        if lines[last].is_empty() {
            lines[last].push_str(word);
        } else if lines[last].chars().count() + 1 + word.chars().count() <= WIDTH {
            lines[last].push(' ');
            lines[last].push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.join("\n")
}

/// A table in Markdown.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
    let head: Vec<String> = head.iter().map(|cell| (*cell).to_owned()).collect();
    let rule = format!("|{}", "---|".repeat(head.len()));
    let rows = rows.iter().map(|row| line(row));
    [line(&head), rule].into_iter().chain(rows).collect::<Vec<_>>().join("\n")
}

/// A command line as a block of code.
pub fn command(line: &str) -> String {
    format!("```sh\n{line}\n```")
}

/// `a, b and c`.
pub fn listed(words: &[String]) -> String {
    match words {
        [most @ .., last] if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        all => all.concat(),
    }
}

#[test]
fn a_block_is_replaced_between_its_markers() {
    let page = "a\n<!-- generated: x -->\nold\n<!-- end of x -->\nb\n";
    let text = replaced(page, &[("x", "new".to_owned())]).unwrap();
    assert_eq!(text, "a\n<!-- generated: x -->\n\nnew\n\n<!-- end of x -->\nb\n");
    assert_eq!(replaced(&text, &[("x", "new".to_owned())]).unwrap(), text);
    assert!(replaced(page, &[("y", String::new())]).is_err());
}
