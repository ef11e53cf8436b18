// A browser without a language of its own (en-US@posix) names one that no number can be formatted by: the plots then use English.
(function () {
  try {
    new Intl.NumberFormat(navigator.language);
  } catch (unknown) {
    Object.defineProperty(navigator, 'language', { value: 'en-US', configurable: true });
  }
})();
