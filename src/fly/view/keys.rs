//! Conversion of keys to commands: a single key for safe commands, a typed word for others.

use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// Word that stops the motors in the air.
pub const KILL_WORD: &str = "kill";
/// Word that arms.
pub const ARM_WORD: &str = "arm";
/// Opens the field for the word: its letters would otherwise be commands.
const WORD_KEY: char = ':';

/// Commands of the operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyCommand {
    /// stop and stay
    Hold,
    /// come down here
    Land,
    /// come back
    Return,
    /// stop the motors now, wherever the vehicle is
    Kill,
    /// arm, and fly
    Arm,
    /// hold, and end the program
    Quit,
}

impl KeyCommand {
    /// The command of a typed line, if there are no single keys: `h`, `l`, `r` or their words, `arm`, `:kill`.
    #[must_use]
    pub fn of_line(line: &str) -> Option<Self> {
        match line.trim().to_ascii_lowercase().as_str() {
            "h" | "hold" => Some(Self::Hold),
            "l" | "land" => Some(Self::Land),
            "r" | "return" => Some(Self::Return),
            ARM_WORD => Some(Self::Arm),
            word if word.strip_prefix(WORD_KEY) == Some(KILL_WORD) => Some(Self::Kill),
            _ => None,
        }
    }
}

/// The keyboard's state.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Keys {
    word: Option<String>,
    /// a page is to come, and no key but Ctrl-C counts before it: the `r` of a word for arming that comes too early is no order to return
    early: bool,
    /// the word for arming is waited for: letters are its letters
    asks: bool,
    /// the line of the page from which on it is read, and the last one from which it is seen to its end
    from: usize,
    last: usize,
    /// it was seen to its end
    read: bool,
    /// what was entered last in place of the word for arming
    refused: Option<String>,
}

/// Lines that are scrolled at once.
const LEAF: usize = 10;

impl Keys {
    /// Of a flight that has a page before it, or has none.
    #[must_use]
    pub fn before(has_page: bool) -> Self {
        Self { early: has_page, ..Self::default() }
    }

    /// Sets whether the word for arming is awaited. Whether it is from now on: what was typed before the question is on the screen is
    /// for [`Self::press_early`].
    pub fn ask(&mut self, asks: bool) -> bool {
        let is_new = asks && !self.asks;
        self.early &= !asks;
        if asks != self.asks {
            (self.asks, self.word, self.refused) = (asks, None, None);
        }
        is_new
    }

    /// Sets the number of lines of the page before the flight, and the number that is visible at once.
    pub fn page(&mut self, lines: usize, seen: usize) {
        self.last = lines.saturating_sub(seen);
        self.turn(self.from);
    }

    /// The line of the page from which on it is read.
    #[must_use]
    pub fn from(&self) -> usize {
        self.from
    }

    /// Whether no key but Ctrl-C counts yet.
    #[must_use]
    pub fn wait(&self) -> bool {
        self.early
    }

    fn turn(&mut self, from: usize) {
        self.from = from.min(self.last);
        self.read |= self.from == self.last;
    }

    /// Takes one key event that came before the question was on the screen: it answers nothing, and Ctrl-C ends the flight all the same.
    #[must_use]
    pub fn press_early(event: KeyEvent) -> Option<KeyCommand> {
        let ends = event.modifiers.contains(KeyModifiers::CONTROL) && event.code == KeyCode::Char('c');
        (ends && event.kind != KeyEventKind::Release).then_some(KeyCommand::Quit)
    }

    /// Takes one key event.
    pub fn press(&mut self, event: KeyEvent) -> Option<KeyCommand> {
        if event.kind == KeyEventKind::Release {
            return None;
        }
        if self.early || event.modifiers.contains(KeyModifiers::CONTROL) {
            return Self::press_early(event);
        }
        if self.asks && self.read && event.code == KeyCode::Enter {
            return self.enter_word();
        }
        self.refused = None;
        match (&mut self.word, event.code) {
            (_, KeyCode::Down) if self.asks => self.turn(self.from.saturating_add(1)),
            (_, KeyCode::Up) if self.asks => self.turn(self.from.saturating_sub(1)),
            (_, KeyCode::PageDown) if self.asks => self.turn(self.from.saturating_add(LEAF)),
            (_, KeyCode::PageUp) if self.asks => self.turn(self.from.saturating_sub(LEAF)),
            (_, KeyCode::Char(' ')) if self.asks => self.turn(self.from.saturating_add(LEAF)),
            (_, KeyCode::Esc) => self.word = None,
            // a word begins once the page was seen whole
            (None, KeyCode::Char(letter)) if self.asks => self.word = self.read.then(|| letter.to_string()),
            (None, KeyCode::Char(WORD_KEY)) => self.word = Some(String::new()),
            (None, KeyCode::Char('h' | 'H' | ' ')) => return Some(KeyCommand::Hold),
            (None, KeyCode::Char('l' | 'L')) => return Some(KeyCommand::Land),
            (None, KeyCode::Char('r' | 'R')) => return Some(KeyCommand::Return),
            (Some(word), KeyCode::Backspace) => {
                word.pop();
            }
            (Some(word), KeyCode::Char(letter)) if word.len() < 2 * KILL_WORD.len() => word.push(letter),
            (Some(_), KeyCode::Enter) => {
                return self
                    .word
                    .take()
                    .filter(|word| !self.asks && word == KILL_WORD)
                    .map(|_| KeyCommand::Kill);
            }
            _ => {}
        }
        None
    }

    /// The word for arming, of a page that was seen whole; another one arms nothing and is kept to be told.
    fn enter_word(&mut self) -> Option<KeyCommand> {
        let word = self.word.take().unwrap_or_default();
        let is_it = word == ARM_WORD;
        self.refused = (!is_it).then_some(word);
        is_it.then_some(KeyCommand::Arm)
    }

    /// What was entered in place of the word for arming, until the next key.
    #[must_use]
    pub fn refused(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    /// The typed part of the word; `None` while keys are commands.
    #[must_use]
    pub fn typed(&self) -> Option<&str> {
        self.word.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(keys: &mut Keys, text: &str) -> Vec<KeyCommand> {
        let code = |letter| if letter == '\n' { KeyCode::Enter } else { KeyCode::Char(letter) };
        text.chars().filter_map(|letter| keys.press(KeyEvent::from(code(letter)))).collect()
    }

    #[test]
    fn one_key_holds_lands_and_returns() {
        let said = press(&mut Keys::default(), "hlrx");
        assert_eq!(said, [KeyCommand::Hold, KeyCommand::Land, KeyCommand::Return]);
    }

    #[test]
    fn a_line_says_what_a_key_would() {
        let said = ["h", " Land\r\n", "return", ":kill"].map(KeyCommand::of_line);
        let wanted = [KeyCommand::Hold, KeyCommand::Land, KeyCommand::Return, KeyCommand::Kill];
        assert_eq!(said, wanted.map(Some));
        assert_eq!(["", "kill", ": kill", "hl", "quit"].map(KeyCommand::of_line), [None; 5]);
    }

    #[test]
    fn only_the_whole_word_kills() {
        let mut keys = Keys::default();
        assert_eq!(press(&mut keys, ":kil\n"), []);
        assert_eq!(press(&mut keys, ":kill"), []);
        assert_eq!(keys.typed(), Some("kill"));
        assert_eq!(press(&mut keys, "\n"), [KeyCommand::Kill]);
        // without the field its letters are what they always are
        assert_eq!(press(&mut keys, "kill\n"), [KeyCommand::Land, KeyCommand::Land]);
        assert_eq!(press(&mut keys, ":ki"), []);
        keys.press(KeyEvent::from(KeyCode::Esc));
        assert_eq!(press(&mut keys, "h"), [KeyCommand::Hold]);
    }

    #[test]
    fn only_the_whole_word_arms_and_only_where_it_is_asked_for() {
        let mut keys = Keys::default();
        assert_eq!(press(&mut keys, "arm\n"), [KeyCommand::Return]);
        assert!(keys.ask(true));
        keys.page(50, 23);
        assert_eq!(press(&mut keys, "arm\n"), [], "most of the page was not seen");
        assert_eq!((press(&mut keys, "  "), keys.from()), (vec![], 20));
        keys.press(KeyEvent::from(KeyCode::PageDown));
        assert_eq!(keys.from(), 27);
        assert_eq!(press(&mut keys, "ar\nh\n:kill\n"), []);
        for wrong in ["fly", "ARM", ""] {
            assert_eq!((press(&mut keys, &format!("{wrong}\n")), keys.refused()), (vec![], Some(wrong)));
        }
        assert_eq!((press(&mut keys, "a"), keys.refused()), (vec![], None));
        assert_eq!(press(&mut keys, "rm\n"), [KeyCommand::Arm]);
        assert!(!keys.ask(false));
        assert_eq!(press(&mut keys, "h"), [KeyCommand::Hold]);
        assert_eq!(KeyCommand::of_line(" arm\n"), Some(KeyCommand::Arm));
    }

    #[test]
    fn control_c_ends_it_even_while_typing() {
        let mut keys = Keys::default();
        press(&mut keys, ":k");
        let event = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
        assert_eq!(keys.press(event), Some(KeyCommand::Quit));
        assert_eq!(Keys::press_early(event), Some(KeyCommand::Quit));
    }

    #[test]
    fn what_is_typed_before_the_question_is_on_the_screen_answers_nothing() {
        let mut keys = Keys::default();
        assert!(keys.ask(true) && !keys.ask(true));
        keys.page(20, 23);
        let early = |letter| Keys::press_early(KeyEvent::from(letter));
        let word = ['a', 'r', 'm', 'h', 'l'].map(KeyCode::Char).into_iter().chain([KeyCode::Enter]);
        assert!(word.into_iter().all(|letter| early(letter).is_none()));
        assert_eq!((press(&mut keys, "m\n"), keys.refused()), (vec![], Some("m")), "nothing of it is left");
        assert_eq!(press(&mut keys, "arm\n"), [KeyCommand::Arm]);
        // asked anew
        assert!(!keys.ask(false) && keys.ask(true));
    }

    #[test]
    fn before_the_page_the_letters_of_a_word_order_nothing() {
        let mut keys = Keys::before(true);
        assert_eq!(press(&mut keys, "arm\nhlr :kill\n"), []);
        let end = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
        assert_eq!(keys.press(end), Some(KeyCommand::Quit));
        assert!(keys.ask(true));
        keys.page(20, 23);
        assert_eq!(press(&mut keys, "arm\n"), [KeyCommand::Arm]);
        assert!(!keys.ask(false));
        assert_eq!(press(&mut keys, "r"), [KeyCommand::Return], "in the air it is one");
        assert_eq!(press(&mut Keys::before(false), "r"), [KeyCommand::Return]);
    }

    #[test]
    fn a_page_that_is_not_seen_whole_takes_no_letters_and_is_turned_all_the_same() {
        let mut keys = Keys::default();
        assert!(keys.ask(true));
        keys.page(63, 23);
        assert!(press(&mut keys, "xarm\n").is_empty() && keys.typed().is_none());
        assert!(press(&mut keys, "    ").is_empty());
        assert_eq!(keys.from(), 40);
        assert_eq!(press(&mut keys, "arm\n"), [KeyCommand::Arm]);
    }
}
