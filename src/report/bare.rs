//! Text that shows no folder, for others to read.

/// A file's name without its folder.
pub(super) fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or_default()
}

/// Text in which files stand without their folders: `known` ones, and whatever else begins as a path does.
pub(super) fn bare(text: &str, known: &[&str]) -> String {
    let mut text = text.to_owned();
    let mut folders: Vec<(&str, &str)> = known
        .iter()
        .map(|path| path.split_at(path.len() - file_name(path).len()))
        .filter(|(folder, _)| !folder.is_empty())
        .collect();
    // one may end as another does
    folders.sort_by_key(|(folder, _)| std::cmp::Reverse(folder.len()));
    for (folder, name) in folders {
        let name = name.split([' ', ',']).next().unwrap_or_default();
        text = text.replace(&format!("{folder}{name}"), name);
    }
    let word = |word: &str| {
        let begin = word.len() - word.trim_start_matches(['(', '[', '`', '"', '\'']).len();
        let (mark, path) = word.split_at(begin);
        let begins = |with: &&str| path.len() > with.len() && path.starts_with(*with);
        let is_path = ["/", "./", "../", "~/"].iter().any(begins) || path.get(1..3) == Some(":\\");
        if is_path { format!("{mark}{}", file_name(path)) } else { word.to_owned() }
    };
    let line = |line: &str| line.split(' ').map(word).collect::<Vec<_>>().join(" ");
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}
